// The order in which readings were taken.
#pragma once

#include <vector>

#include "validation/measurement/measurements.h"

namespace deflect::measurement {

/// Those of a pose, by index: by their `sequence`, else as in the file.
std::vector<std::size_t> in_order(const PoseGroup&, const Measurements&);

}  // namespace deflect::measurement
