// The evidence of data for an effect (Bayes factor).
//
// Let k parameters reduce χ² by g, and let a be the effect's amplitude in its own standard deviations. It is observed
// as z = a + N(0, 1) with |z|² = g. The prior of a is Gaussian with standard deviation τ per parameter, and τ is
// uniform in ln τ from 1/2 to 500, so that no size of an effect is preferred and the bounds of its parameters have no
// influence. The evidence against "nothing" is then
//   B = ⟨ (1 + τ²)^(−k/2) exp(½ g τ²/(1 + τ²)) s ⟩_τ,   s = 2 Φ(√g τ/√(1 + τ²)) where the sign is fixed, else 1.
//
// Play that is wider than the motion and a part that is gone predict the same (lets_go(), diagnosis/signatures.h).
// Their gains are then equal and so is the evidence, but for the sign that physics fixes: they come as a tie. This is a
// convention. B asks how far a residual is from nothing, not how much of a parameter's range is as good: all widths
// from the one at which nothing touches, however many there are, count once, as does the one stiffness 0. A prior on
// the width itself would give play as much more or less as it has beyond that width, which nobody knows.
#pragma once

#include <vector>

namespace deflect::statistics {

/// ln B.
double log_evidence(double gain, int parameters, bool one_sided);

/// Probabilities of hypotheses from ln(prior · evidence).
std::vector<double> normalised(const std::vector<double>& log_weights);

/// Of what has this evidence in its favour, and these odds before any reading.
double probability_of(double log_evidence, double prior_odds);

/// ln of the mean and of the sum of exp(x).
double log_mean_exp(const std::vector<double>& x);
double log_sum_exp(const std::vector<double>& x);

/// χ² of so many numbers with two of its standard deviations: more is not noise alone.
double most_by_noise(double numbers);

/// `count` numbers between low and high, evenly spaced in their logarithm, none at the ends.
std::vector<double> log_spaced(double low, double high, int count);

}  // namespace deflect::statistics
