// A hypothesis: effects, each with its place, whose parameters are fitted.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "validation/diagnosis/observations.h"
#include "validation/effects/with_effect.h"

namespace deflect::diagnosis {

using Hypothesis = std::vector<effects::PlacedEffect>;

inline bool same(const effects::PlacedEffect& a, const effects::PlacedEffect& b) {
  return a.effect == b.effect && a.leg == b.leg;
}

/// An effect is not taken twice. Where it is large its signature, which is that of a small one, does not show that it
/// is there.
inline bool is_among(const Hypothesis& h, const effects::PlacedEffect& e) {
  return std::any_of(h.begin(), h.end(), [&](const effects::PlacedEffect& p) { return same(p, e); });
}

/// Of an effect at a place "clearance", of an entry its name.
inline std::string law_of(const effects::PlacedEffect& e) { return e.effect->name.substr(0, e.effect->name.find('@')); }

/// "guide_root_compliance", "leg_defect (leg 5)".
std::string name_of(const effects::PlacedEffect&);

/// Bounded least squares of the whitened residual over the parameters (MINPACK's Levenberg–Marquardt, from the best of
/// a few start points). Coordinates: fit_problem.h.
struct Fit {
  VectorX values;      ///< in the parameters' units, effect after effect
  MatrixX covariance;  ///< of the coordinates
  MatrixX signature;   ///< derivative of the whitened residual with respect to the coordinates
  VectorX residual;    ///< whitened, at the values; behind the measured numbers a row for each prior
  double chi2 = 0;
  std::vector<std::pair<double, double>>
      limits;          ///< 95 % interval of each value, where they were computed (interval.h)
  bool found = false;  ///< false: no value was found at which the device can be predicted
  std::string why;     ///< where not found: the error at the first value tried
};
/// `from`: values of the first effects, which were fitted before. The last effect starts from `guess`, else from the
/// best of a few start points.
Fit fit(const Observations&, const Hypothesis&, const VectorX& from = {}, const std::optional<VectorX>& guess = {},
        int threads = 1);

/// The same from given start values of all effects. Without effects: the null hypothesis.
Fit fit_of_all(const Observations&, const Hypothesis&, const VectorX& values);

/// A fit, or a better one: each effect that parameters shape is looked for again over its whole range beside the
/// others, since effects that were fitted one after the other may stand in a valley of χ² that is not the deepest.
Fit searched_again(const Observations&, const Hypothesis&, Fit, int threads);

/// A Fit with found = false and the reason.
Fit not_found(std::string why);

/// The hypothesis and its values without effect i.
std::pair<Hypothesis, VectorX> without(Hypothesis, const VectorX& values, std::size_t i);

/// The subject with the effects at these values.
subject::Subject subject_with(const Observations&, const Hypothesis&, const VectorX& values);
/// ln of the likelihood of the readings where these effects are right, tolerances as these observations weigh them; see
/// Observations::log_likelihood_of_scales().
double log_likelihood(const Observations&, const Hypothesis&, const VectorX& values);

/// The parameters of all effects, one after the other.
std::vector<const effects::EffectParameter*> parameters_of(const Hypothesis&);

/// Whether the last effect has several parameters and one of them is fitted to a bound. It is then really a simpler
/// effect (a spring that would harden only far beyond the data is a linear one).
bool runs_to_a_bound(const Hypothesis&, const Fit&);

/// Whether the last effect has one parameter and it is fitted to a bound at which the effect does not vanish: the data
/// ask for a larger effect than the bounds allow. A factor that is next to nothing is as large an effect as there is.
bool wants_more_than_there_can_be(const Hypothesis&, const Fit&);

/// Whether it has parameters beside its amplitude, which determine its shape (a friction's stiffness, an exponent).
bool is_shaped(const effects::PlacedEffect&);

/// Whether physics fixes the sign of the effect's amplitude (one parameter, which vanishes at a bound).
bool one_sided(const effects::PlacedEffect&);

/// A factor on several stiffnesses at once, as those of a beam: where it is large it moves the readings in another
/// direction than a little of it. (A single stiffness keeps its direction: K changes by a rank-one term.)
bool turns_as_it_grows(const effects::Effect&);

/// Of two laws at places.
bool at_one_place(const effects::PlacedEffect&, const effects::PlacedEffect&);
/// Whether the first is the same law at a group that has the place of the second.
bool is_wider(const effects::PlacedEffect&, const effects::PlacedEffect&);

}  // namespace deflect::diagnosis
