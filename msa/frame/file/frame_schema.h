// The keys of frame files as data: schema.h, from the field list of frames.
#pragma once

#include "msa/fields/schema.h"

namespace deflect::frame {

Schema frame_schema();

}  // namespace deflect::frame
