// A hypothesis: effects, each with its place, whose parameters are to be found.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/diagnosis/observations.h"
#include "validation/effects/with_effect.h"

namespace deflect::diagnosis {

using Hypothesis = std::vector<effects::PlacedEffect>;

/// "guide_root_compliance", "leg_defect (leg 5)".
std::string name_of(const effects::PlacedEffect&);

/// Least squares of the whitened residual over the parameters, those on a logarithmic scale in their logarithm, within
/// their bounds (Levenberg–Marquardt, MINPACK's, from the best of a few starts).
struct Fit {
  VectorX values;      ///< in the parameters' units, effect after effect
  MatrixX covariance;  ///< of the coordinates: ln of parameters on a logarithmic scale
  MatrixX signature;   ///< derivative of the whitened residual by the coordinates
  VectorX residual;    ///< whitened, at the values
  double chi2 = 0;
  bool found = false;  ///< false: the device cannot be predicted with it anywhere
  std::string why;     ///< not found: what the first value that was tried met with
};
/// `from`: values of the effects that were fitted before, the first ones. The last effect starts from the guess (its
/// values), else from the best of a few.
Fit fit(const Observations&, const Hypothesis&, const VectorX& from = {}, const std::optional<VectorX>& guess = {});

/// The same from values of all of them, without a search for starts; of no effect: the null.
Fit fit_of_all(const Observations&, const Hypothesis&, const VectorX& values);

/// A fit, or a better one: each effect that parameters shape is looked for again over its whole range beside the
/// others, since effects that were fitted one after the other may stand in a valley of χ² that is not the deepest.
Fit searched_again(const Observations&, const Hypothesis&, Fit, int threads);

/// A fit that there is none of, and why.
Fit not_found(std::string why);

/// What is left when effect i is taken away, and the values of that.
std::pair<Hypothesis, VectorX> without(Hypothesis, const VectorX& values, std::size_t i);

/// The subject with the effects at those values.
subject::Subject subject_with(const Observations&, const Hypothesis&, const VectorX& values);

/// 95 % interval of parameter i: in the logarithm for a logarithmic scale, within the bounds.
std::pair<double, double> interval95(const Hypothesis&, const Fit&, std::size_t i);

/// The parameters of all effects, one after the other.
std::vector<const effects::EffectParameter*> parameters_of(const Hypothesis&);

/// Whether the last effect's fit stands at a bound of one of several parameters: it is then another, simpler effect (a
/// spring that would harden far beyond the data is a linear one).
bool runs_to_a_bound(const Hypothesis&, const Fit&);

/// Whether the last effect's one parameter is fitted to a bound at which it does not vanish: more of it would be needed
/// than there can be.
bool wants_more_than_there_can_be(const Hypothesis&, const Fit&);

/// Whether an amplitude of the effect has a sign that physics fixes (one parameter, which vanishes at a bound).
bool one_sided(const effects::PlacedEffect&);

}  // namespace deflect::diagnosis
