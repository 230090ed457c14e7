// Measurements of one subject from several sessions, as one.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "validation/measurement/measurements.h"

namespace deflect::measurement {

/// The readings of all, in order. A pose label that stands in an earlier one too gets its session's number, "3 (2)",
/// because a pose that is approached again has errors of its own. Sequence numbers continue where the session before
/// ended; where a session has none, none is kept. Lines are counted through. Instruments: those of all. Throws
/// InputError where one commands poses and another joint coordinates. `all` must not be empty.
Measurements joined(const std::vector<Measurements>& all);

/// Of each session its text and where that is from. Throws InputError where a text stands twice: the same numbers read
/// once are no replicates.
void require_different(const std::vector<std::pair<std::string, std::string>>& sessions);

}  // namespace deflect::measurement
