// Tails of distributions (Boost.Math, instantiated once).
#pragma once

namespace deflect::statistics {

/// Upper tail of the χ² distribution; 1 for 0 degrees of freedom.
double chi_squared_tail(double freedoms, double chi2);

/// Inverse of chi_squared_tail() in χ², for 0 < tail < 1; infinite for a tail of 0.
double chi_squared_at_tail(double freedoms, double tail);

/// Φ(x), the standard normal distribution function.
double normal_distribution(double x);

}  // namespace deflect::statistics
