// Example values, as in a file, for messages.
#pragma once

#include <string>
#include <string_view>

#include "msa/base/units.h"

namespace deflect {

/// "10 mm" for a length.
const char* example_of(Dimension);

/// "key: value", and "value" where an entry is the value itself.
std::string example_of(std::string_view key, const std::string& value);

}  // namespace deflect
