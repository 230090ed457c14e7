// The schema (schema.h) of frame files, from the list of their fields.
#pragma once

#include "msa/fields/schema.h"

namespace deflect::frame {

Schema frame_schema();

}  // namespace deflect::frame
