// What does nearly as well as an effect that was found.
#pragma once

#include <string>
#include <vector>

#include "validation/diagnosis/candidates.h"

namespace deflect::diagnosis {

/// What does nearly as well as an effect, in its place.
struct Tie {
  std::vector<std::string> names;  ///< what was found, then the best first, until they have 95 % of the probability
  std::vector<Candidate> rivals;   ///< the best of each name, as fitted, with its probability among all

  bool holds(const Candidate&) const;  ///< or another place of the same entry
  /// What was found comes before those that tie with it.
  void put_first(const Candidate&);
};

/// Of candidates for one effect, fitted to these observations. Empty where one of them has more than 90 % of the
/// probability.
Tie tie_of(const std::vector<Candidate>&, const Observations&);

/// The likeliest of those that do as well as this one with fewer parameters and leave the same as it does at a bound,
/// as a restraint does; null where there is none.
const Candidate* simpler_form(const Candidate&, const std::vector<Candidate>&, const Observations&);

}  // namespace deflect::diagnosis
