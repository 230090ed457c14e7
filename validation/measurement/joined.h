// Measurements of one subject from several sessions, as one.
#pragma once

#include <vector>

#include "validation/measurement/measurements.h"

namespace deflect::measurement {

/// The readings of all, in order. A pose label that stands in an earlier one too gets its session's number, "3 (2)",
/// because a pose that is approached again has errors of its own. Sequence numbers continue where the session before
/// ended; where a session has none, none is kept. Lines are counted through. Instruments: those of all. Throws
/// InputError where one commands poses and another joint coordinates. `all` must not be empty.
Measurements joined(const std::vector<Measurements>& all);

}  // namespace deflect::measurement
