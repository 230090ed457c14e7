// Stepwise selection of effects. Effects are added one by one as long as the evidence supports them. After each
// addition every accepted effect is tested again, given the others: it is dropped where it is no longer needed, and
// replaced where another does better. Before a further one is added, two of the effects at once, or a single one, are
// replaced by two others that do better together (pairs.h).
//
// Four effects are enough where noise is what is left. Where the model is far worse than the noise, as of a real gear
// unit, evidence calls for ever more; a fifth and a sixth are added where each takes off half of what the others leave.
#pragma once

#include <cmath>
#include <functional>

#include "validation/diagnosis/candidates.h"
#include "validation/diagnosis/ties.h"

namespace deflect::diagnosis {

struct Selection {
  Observations observations;      ///< with the effects found (Observations::granted)
  Hypothesis effects;             ///< in the order in which they were added
  Fit fit;                        ///< of all effects together; without effects, of the null hypothesis
  std::vector<Tie> ties;          ///< by effect; empty where one of them has more than 90 % of the probability
  std::vector<LeftOut> left_out;  ///< could not be fitted beside the others
};

/// That something more is missing beside what was found: its odds before any reading.
inline constexpr double further_odds = 1.0 / 3;
/// A further effect is added only where ln of its odds exceeds this. They are counted from those of something missing
/// at all (Candidates::prior_missing): with those of something more, it is then likelier than not.
inline const double called_for = std::log(Candidates::prior_missing / (1 - Candidates::prior_missing) / further_odds);

/// After each step the effects found so far count as right (Observations::granted). `first`: candidates of the first
/// step. `enough`: whether no further effect is to be looked for beside these, which are two or more.
Selection select(const Observations&, const Candidates&, const std::vector<Candidate>& first,
                 const std::function<bool(const Selection&)>& enough = {});

/// Its effects and those that tie with them, with the values that were fitted last.
std::vector<effects::EffectInstance> as_fitted(const Selection&);

/// ln(prior · evidence) of effects against none of them. Each counts as having an equal share in what they gain
/// together in χ²: they are found one beside another, in an order that says nothing.
double log_odds_of_all(const Candidates&, const Hypothesis&, double gain);

}  // namespace deflect::diagnosis
