// The data that a diagnosis has to explain: the measured numbers and their uncertainty.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>

#include "validation/compare/comparison.h"
#include "validation/compare/held_out.h"
#include "validation/diagnosis/discrepancy.h"

namespace deflect::diagnosis {

/// σ of a value: by how much the deformed shape may be off.
inline constexpr double known_shape = 0.1;

/// Holds a comparison with its uncertainty and computes residuals for any edited subject. The contribution of
/// equilibrium in the deformed shape is known to compare::shape_known_to; this uncertainty is one more nuisance
/// parameter.
class Observations {
 public:
  /// `tolerance_scale`: how large tolerances count, times as declared; none: as large as the data show them
  /// (Uncertainty::scale_of_tolerances).
  Observations(const subject::Subject&, const measurement::Measurements&, const compare::ComparisonOptions&,
               const parallel::Work& = {}, std::optional<double> tolerance_scale = {});

  const subject::Subject& subject() const { return subject_; }
  const compare::Comparison& comparison() const { return *comparison_; }
  const statistics::Uncertainty& uncertainty() const { return *uncertainty_; }
  std::size_t numbers() const { return uncertainty_->count(); }
  double tolerance_scale() const { return tolerance_scale_; }
  /// ln of the likelihood of residual() of a subject under tolerances s times as large as they count here, for each s,
  /// up to a constant that is the same in all copies with the same readings. Zeros of readings and the size of the
  /// deformed shape's contribution are fitted.
  std::vector<double> log_likelihood_of_scales(const subject::Subject&, const std::vector<double>& scales) const;
  std::size_t set_aside() const;  ///< readings
  /// Readings whose load leaves play open and that may stand anywhere in it (open_play.h).
  std::size_t in_play() const { return load_errors_->readings_in_play(); }
  const std::vector<bool>& aside() const { return aside_; }  ///< by reading

  /// Measured − predicted for a subject, m and rad. The prediction is that of linear geometry plus shape_for() the
  /// subject, or that of in_true_geometry().
  VectorX residual(const subject::Subject&) const;
  /// The same in the subject's true geometry, at these readings of a machine only: the numbers of others mean nothing.
  /// Empty: at all. Throws NumericalError where it does not stand in it.
  VectorX residual_in_shape(const subject::Subject&, const std::vector<bool>& only) const;
  /// W times residual(), with WᵀW = Σ⁻¹ (whitening.h).
  VectorX whitened_residual(const subject::Subject&) const;
  /// The same with a contribution of the deformed shape that shape_for() told of a subject like it.
  VectorX whitened_residual(const subject::Subject&, const VectorX& shape) const;
  /// The contribution of the deformed shape to a subject's readings, m and rad: the one that is granted (see
  /// granted()), or, at readings where other play floats than in the granted subject (prediction::Floating), the
  /// subject's own, which says where in the play it stands.
  VectorX shape_for(const subject::Subject&) const;
  const VectorX& granted_shape() const { return shape_; }
  /// The same for the subject as given, in which nothing is missing.
  const VectorX& null_residual() const { return null_; }
  /// All patterns that a residual can have (discrepancy.h), whitened by the uncertainty. Computed anew at every call.
  std::shared_ptr<const WhitenedFamilies> whitened_patterns() const;

  /// Whether the readings of a subject would depend on the loads before them.
  bool has_history(const subject::Subject&) const;

  /// Root mean square of measured − predicted over the readings not set aside: of translations, m, or, where only
  /// rotations were measured, of rotations, rad.
  double rmse(const subject::Subject&) const;
  /// The same by cross-validation: at each pose with the tolerances fitted at the other poses (ten folds at most).
  double held_out_rmse(const subject::Subject&) const;
  /// Whether that error is no larger for this subject than for the other one, but for chance: false where the sum over
  /// folds of the differences of squares exceeds twice its standard error, which the differences themselves tell; of
  /// one fold, where it exceeds 0. What an effect does that a tolerance can do as well, the tolerance learns at the
  /// other poses: the error stays then.
  bool falls_held_out(const subject::Subject&, const subject::Subject& other) const;
  /// Tolerances that would deviate by more than two declared standard deviations if this subject were right; each with
  /// its number of standard deviations.
  std::vector<std::pair<std::string, double>> strained(const subject::Subject&) const;

  /// A copy for which this subject counts as right: what its tolerances do and the contribution of the deformed shape
  /// are computed for it (a missing member changes what its neighbours' tolerances do, a payload what those of drives
  /// do), and readings that are gross outliers to it are set aside, unless they are more than one in twenty; one of ten
  /// or more may be. Readings whose load leaves its play open may stand anywhere in it where that is likelier than
  /// where the deformed shape puts them (open_play.h).
  Observations granted(const subject::Subject&) const;
  /// How far the contribution of the deformed shape may change where this subject counts as right instead of the one
  /// that does, and is like it: the norm in σ of noise of the whole. No value moves by more than about so many of its
  /// σ. Estimated in linear geometry: a contribution that is even in the load, or a load on what it displaces, grows
  /// twice as fast as the displacement.
  double change_of_shape(const subject::Subject&) const;
  /// Whether the deformed shape contributes more than a twentieth of what is predicted, as under more than a twentieth
  /// of the load that buckles a frame: a fixed contribution does not do then. Where it puts floating play does not
  /// count: shape_for() follows that.
  bool is_slender() const;
  /// A copy in which every subject is predicted in its true geometry, which takes far longer. Residuals of a subject
  /// that does not stand in it throw (RangeError); null_residual() is then the one of this.
  Observations in_true_geometry() const;
  /// A copy in which the contribution of the deformed shape is shape_for() this subject.
  Observations in_shape_of(const subject::Subject&) const;
  /// A copy whose hypotheses are about this subject: effects are added to it, it is subject() and null_residual() is
  /// its. Weights, tolerances and what is granted stay those of the subject of this one.
  Observations about(const subject::Subject&) const;
  /// A copy in which these readings are set aside.
  Observations keeping(const std::vector<bool>& aside) const;
  /// A copy in which these tolerances, by their index among those of the comparison, are exact.
  Observations exact_in(const std::vector<std::size_t>& tolerances) const;

  /// A copy that weighs by what tolerances and errors of loads do to this subject, of a machine too: a leg that bends
  /// three times as far also does so where its rod is thinner than drawn. For values and their intervals; the
  /// probabilities of effects are compared by one weight for all of them.
  Observations weighed_for(const subject::Subject&) const;

 private:
  std::shared_ptr<const subject::Standing> stand(const subject::Subject&) const;
  struct Linear {
    VectorX values;
    prediction::Floating floating;
  };
  Linear linear(const subject::Subject&) const;                        // what is predicted in linear geometry
  VectorX shape_beside(const Linear&, const subject::Subject&) const;  // shape_for() a subject of which that is
  double in_noise(const VectorX& values) const;                        // their norm in σ of noise
  VectorX residual_held_out(const subject::Subject&) const;
  /// Subtracts the estimated zero of the readings where it is unknown.
  VectorX from_zero(VectorX residual) const;
  void weigh(const std::vector<bool>& aside);
  /// What the deformed shape of `subject`, for which in_linear_ and floating_ stand, adds where it does not move that
  /// play.
  VectorX bent_of(const subject::Subject&) const;
  void move_tolerances(const subject::Subject&);

  subject::Subject subject_;
  // Shared by all copies that granted() makes.
  std::shared_ptr<const compare::Comparison> comparison_;
  int threads_;
  double tolerance_scale_ = 1;
  std::vector<bool> aside_;
  std::shared_ptr<const statistics::PartedColumns> A_;  // the last shared column is that of the deformed shape
  std::shared_ptr<const statistics::LoadErrors> load_errors_;
  std::shared_ptr<const statistics::Uncertainty> uncertainty_;
  std::optional<compare::HeldOut> held_out_;
  VectorX measured_, shape_, null_;
  VectorX bent_;                   // shape_ without where it puts floating play
  VectorX in_linear_;              // prediction in linear geometry of the subject whose deformed shape is granted
  prediction::Floating floating_;  // play in that subject
  bool true_geometry_ = false;
};

}  // namespace deflect::diagnosis
