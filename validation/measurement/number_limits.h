// How large and how small numbers of a measurement file may be.
#pragma once

namespace deflect::measurement {

/// In the units of the columns: far beyond any machine, and far below where squares of it are no numbers.
inline constexpr double largest_measured = 1e12;

/// Of a standard deviation, in m and rad: what is smaller is none.
inline constexpr double least_sigma = 1e-30;

/// Of a standard deviation, in m and rad: what is smaller is asked about. An atom is 1e-10 m wide.
inline constexpr double finest_sigma = 1e-12;

}  // namespace deflect::measurement
