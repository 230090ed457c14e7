// Example values, as in a file, for messages.
#pragma once

#include "msa/base/units.h"

namespace deflect {

/// "10 mm" for a length.
const char* example_of(Dimension);

}  // namespace deflect
