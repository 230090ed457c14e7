// Which effects together: added one by one as long as they are called for; after each addition every one of them is
// asked again, beside the others, whether it is still called for and whether another would do better in its place.
#pragma once

#include "validation/diagnosis/candidates.h"

namespace deflect::diagnosis {

struct Selection {
  Observations observations;  ///< with what was found granted
  Hypothesis effects;         ///< in the order in which they were added
  Fit fit;                    ///< of all of them; without effects: the null
  /// Per effect what does nearly as well in its place: names, best first, where together they have 95 % of the
  /// probability there; empty where one has more than 90 %.
  std::vector<std::vector<std::string>> ties;
  std::vector<LeftOut> left_out;  ///< could not be fitted beside the others
};

/// ln of the odds from which a further effect is called for.
inline constexpr double called_for = 4;

/// What is right so far becomes granted (Observations::granted). `first`: candidates of the first step.
Selection select(const Observations&, const Candidates&, const std::vector<Candidate>& first);

}  // namespace deflect::diagnosis
