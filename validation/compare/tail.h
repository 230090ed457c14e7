// Tails of distributions (Boost.Math, instantiated once).
#pragma once

namespace deflect {

/// Probability that chance makes χ² with that many degrees of freedom at least as large; 1 without any.
double chi_squared_tail(double freedoms, double chi2);

/// Φ(x) of the standard normal distribution.
double normal_distribution(double x);

}  // namespace deflect
