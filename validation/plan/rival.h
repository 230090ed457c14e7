// A rival as a plan needs it: what it predicts of a prospect's readings, its derivatives, and its fit to other
// readings.
//
// Coordinates of its parameters are those of fit_problem.h. The rival is fitted to readings y by Gauss–Newton steps: at
// the coordinates x, with d their distance from x₀, the means of their priors (without one, those that were fitted to
// the data), and J the derivatives of the prediction μ,
//   λ² = min over z, η of |W (y − μ(x) + J d − J z − X η)|² + zᵀ Π_x⁻¹ z + ηᵀ Π⁻¹ η     (design.h)
// gives z, the next d, and what it promises to leave; a step is halved until it leaves less than before. For a law that
// is linear in its coordinates the first step is the last one. Where much is left, the fit begins once more far away,
// where least is left: at the fit to the data a law may say too little for its derivatives to lead anywhere.
#pragma once

#include <optional>
#include <vector>

#include "validation/diagnosis/found_effects.h"
#include "validation/diagnosis/hypothesis.h"
#include "validation/effects/with_effect.h"
#include "validation/plan/prospect.h"

namespace deflect::plan {

struct Rival {
  diagnosis::Hypothesis hypothesis;  ///< what was found beside it first; itself last
  VectorX values;                    ///< as fitted together
  double probability = 0;            ///< among the rivals

  const effects::PlacedEffect& own() const { return hypothesis.back(); }
};

/// The rivals of a tie that a diagnosis found; their probabilities sum to 1. Throws InputError as
/// diagnosis::instance() does. The effects must outlive them.
std::vector<Rival> rivals_of(const diagnosis::FoundTie&, const std::vector<effects::Effect>&);

subject::Subject subject_with(const subject::Subject&, const Rival&, const VectorX& values);
/// With the most probable one as fitted.
subject::Subject subject_with_likeliest(const subject::Subject&, const std::vector<Rival>&);

struct Linearised {
  VectorX at;         ///< coordinates
  VectorX predicted;  ///< by measured number; SI
  MatrixX beside;     ///< its derivatives with respect to the coordinates, whitened by noise
};

/// What is left of readings by a fit to them, and where it ended.
struct Refitted {
  VectorX at;
  double left = 0;  ///< λ²
};

class RivalModel {
 public:
  /// The prospect must outlive it. Throws InputError where the effects do not go together.
  RivalModel(const Prospect&, const subject::Subject&, Rival);

  /// Both throw what the prediction throws.
  VectorX predicted(const VectorX& coordinates) const;
  Linearised at(const VectorX& coordinates) const;
  Linearised at_fit() const { return at(fitted_); }

  /// Fitted to the readings `y` (by measured number, SI) of the prospect that were taken, or to all; `from`: at the
  /// fit.
  Refitted fitted_to(const VectorX& y, const Linearised& from, bool all) const;

  /// The change of readings to `y` that it must absorb about `here`, whitened: W (y − μ(x)) + J d.
  VectorX target(const VectorX& y, const Linearised& here) const;

  /// Variances of the coordinates before any reading, of a parameter's own prior or wide ones, and their covariance
  /// after those taken, by its derivatives.
  const VectorX& prior() const { return prior_; }
  MatrixX covariance(const Linearised& fit) const;

  /// The nearest coordinates within the bounds.
  VectorX within(const VectorX& coordinates) const;
  /// The readings taken without what their true geometry adds at the fit, and without gross errors
  /// (Prospect::off_taken()), whitened; throws what the prediction throws. And what tolerances leave of these at some
  /// coordinates (Prospect::left_of_taken()), with a row for each prior of a parameter's own; nothing beyond a bound
  /// and where the prediction fails.
  VectorX taken_as_linear() const;
  std::optional<VectorX> residual_of_taken(const VectorX& coordinates, const VectorX& taken_as_linear) const;

 private:
  /// λ² of what tolerances leave at those coordinates, and of their distance from the means of the priors.
  double left_at(const VectorX& y, const VectorX& coordinates, const VectorX& predicted, bool all) const;
  Refitted search(const VectorX& y, Linearised from, bool all) const;

  const Prospect* prospect_;
  Rival rival_;
  effects::PreparedEffects prepared_;
  VectorX fitted_, mean_, prior_;
  std::vector<Eigen::Index> known_;  // coordinates with a prior of their own
};

}  // namespace deflect::plan
