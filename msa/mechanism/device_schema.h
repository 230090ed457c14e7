// The schema of device files and of laws: their keys as data.
#pragma once

#include <string>

#include "msa/fields/schema.h"

namespace deflect {

/// For device files of a family (family_names).
Schema device_schema(const std::string& family);

/// For a law on a translation or on a rotation: one level with a case for each law.
Schema law_schema(bool rotation);

}  // namespace deflect
