// Tails of distributions (Boost.Math, instantiated once).
#pragma once

namespace deflect::statistics {

/// Probability that chance makes χ² with that many degrees of freedom at least as large; 1 without any.
double chi_squared_tail(double freedoms, double chi2);

/// The χ² that has this tail, 0 < tail < 1; infinite for a tail of 0.
double chi_squared_at_tail(double freedoms, double tail);

/// Φ(x) of the standard normal distribution.
double normal_distribution(double x);

}  // namespace deflect::statistics
