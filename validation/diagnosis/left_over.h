// What is left of the misfit once effects are fitted: whether something unknown is in it, and which effects stay named
// beside it.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "validation/diagnosis/at_places.h"
#include "validation/diagnosis/selection.h"

namespace deflect::diagnosis {

/// Something unknown shows as a pattern that is common in machines (discrepancy.h) or as an unknown law at a place
/// (at_places.h); both have the same prior.
struct LeftOver {
  double log_evidence = 0;  ///< in favour of something unknown
  double p_value = 1;       ///< chance of as much where only noise and tolerances are left
  /// The places of an unknown law that explains more than all effects, if these are there (AllAtOnePlace).
  std::vector<Localised> instead = {};

  bool significant() const { return log_evidence > 2 && p_value < least_p; }
  static constexpr double least_p = 3e-3;
};

/// `places`: laws at places beside that fit (at_places()).
LeftOver left_over(const std::shared_ptr<const WhitenedFamilies>&, const std::vector<AtPlace>& places, const Fit&);

/// Laws at places without any effect and beside those of a selection, both as its observations weigh them.
struct ByPlaces {
  Fit null;  ///< without any effect
  std::vector<AtPlace> alone, beside;
};
ByPlaces by_places(const Weighed&, const Selection&, int threads);

/// Of the entries without a place the one that takes most of what the fit leaves, and how much, in χ²; "" and 0 where
/// none takes any.
std::pair<std::string, double> nearest_entry(const Weighed&, const Fit&);

/// What these effects leave, in words: the places where an unknown law takes nearly all of it, if none of the effects
/// is there or the law is `instead` of them; else its patterns.
std::string pattern_left(const Selection&, const std::vector<Localised>&, bool instead);

/// Several effects can add up to what one law does that none of them is.
struct AllAtOnePlace {
  Selection there;        ///< the effects that are of that place, fitted anew
  LeftOver instead;       ///< that law against all the effects; its shares are of what those of that place leave
  bool all_there = true;  ///< whether all of them are
};
/// Where an unknown law at one place alone is likelier than all the effects and an unknown law beside them: by `more`
/// in ln of the odds where some of these are of another place, else significantly. Nullopt where it is not. Noise
/// counts as large as the better of the two leaves it.
std::optional<AllAtOnePlace> at_one_place(const ByPlaces&, const Candidates&, const Selection&, double more);

/// ln of the odds from which one is clearly likelier than the other.
inline constexpr double clearly = 4;
/// ln of the odds by which a law at one place must be likelier, where effects alone leave nothing unknown.
inline const double clearly_one_place = clearly - std::log(Candidates::prior_unknown);

/// Whether that law is clearly likelier, whatever the places of the effects, and leaves no more than noise does; where
/// an effect is of another place, little more: then no further effects are to be looked for.
bool is_all_at_one_place(const ByPlaces&, const Candidates&, const Selection&);

/// Those of the effects that are called for even beside something unknown: where it takes what a common pattern can,
/// and where it is a law at a place other than the effect's own.
Selection named_beside_unknown(const std::shared_ptr<const WhitenedFamilies>&, const Weighed&, const Candidates&,
                               Selection);

}  // namespace deflect::diagnosis
