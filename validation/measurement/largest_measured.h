// The largest number that a measurement file may hold.
#pragma once

namespace deflect::measurement {

/// In the units of the columns: far beyond any machine, and far below where squares of it are no numbers.
inline constexpr double largest_measured = 1e12;

}  // namespace deflect::measurement
