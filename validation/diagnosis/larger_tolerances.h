// Larger tolerances as a rival of missing effects. A machine whose parts deviate twice as far as declared leaves a
// misfit that some effect, one of hundreds, comes near. What tells them apart is that larger tolerances show in many
// places at once.
//
// All tolerances are s times as large as declared, ln s uniform between 0 and ln 3. Their evidence against tolerances
// as declared is B = ⟨L(s)⟩ / L(1), with L(s) the likelihood of the residual where nothing is missing
// (scaled_groups.h). Zeros of readings and the contribution of the deformed shape are no tolerances: they are fitted at
// each s.
#pragma once

#include "validation/diagnosis/candidates.h"
#include "validation/diagnosis/observations.h"

namespace deflect::diagnosis {

struct LargerTolerances {
  double scale = 1;        ///< the likeliest s, of tolerances as they are weighed in the observations
  double log_odds = -1e9;  ///< ln(prior · B) against nothing missing and tolerances as declared
};

/// `prior`: odds of larger tolerances against those declared, before any reading. A choice: one machine in three is
/// built worse than its drawing says.
LargerTolerances larger_tolerances(const Observations&, double prior = 0.5);

/// How large tolerances look beside what was found, times as declared: the likeliest of 1 … 3 where this subject counts
/// as right, or 1 unless that raises ln of the likelihood by more than 2. As large as they count already where that is
/// nearly the same, and where something unknown, of which `unknown` is ln of the odds, is likelier than larger ones.
double tolerance_scale_beside(const Observations&, const subject::Subject&, std::optional<double> unknown);

/// σ of every measured number as this subject leaves it. Empty where all of them are told, or none of the others falls
/// by a quarter: a few effects chosen out of hundreds take some off by chance.
std::vector<double> noise_beside(const compare::Comparison& before, const subject::Subject&,
                                 const measurement::Measurements&, compare::ComparisonOptions, const parallel::Work&);

inline constexpr double not_several = -1e9;  ///< ln of the odds of several effects where there are none

/// ln of the weights of candidates, each alone, then of larger tolerances and of "nothing", 0. Several effects can
/// explain together what none does alone: where their ln of odds `together` is larger than that of all candidates,
/// these share it as they share their own.
std::vector<double> log_weights(const std::vector<Candidate>&, const LargerTolerances&, double together = not_several);

}  // namespace deflect::diagnosis
