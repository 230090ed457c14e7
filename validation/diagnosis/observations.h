// What a diagnosis has to explain: the measured numbers with all that is known of their scatter.
#pragma once

#include <memory>
#include <optional>

#include "validation/compare/comparison.h"
#include "validation/compare/held_out.h"
#include "validation/diagnosis/discrepancy.h"

namespace deflect::diagnosis {

/// A comparison, its uncertainty kept, and predictions asked for again and again. Tolerances count as large as the
/// data say where they look larger than declared (Uncertainty::scale_of_tolerances); what equilibrium in the deformed
/// shape adds is known to a fifth of it, one more nuisance.
class Observations {
 public:
  Observations(const subject::Subject&, const measurement::Measurements&, const compare::ComparisonOptions&,
               const parallel::Work& = {});

  const subject::Subject& subject() const { return subject_; }
  const compare::Comparison& comparison() const { return *comparison_; }
  const statistics::Uncertainty& uncertainty() const { return *uncertainty_; }
  std::size_t numbers() const { return uncertainty_->count(); }
  double tolerance_scale() const { return tolerance_scale_; }
  std::size_t set_aside() const;  ///< readings

  /// Measured − predicted, m and rad, of a subject, small displacements, the deformed shape's share added (see below).
  VectorX residual(const subject::Subject&) const;
  /// Σ^(−1/2) of it.
  VectorX whitened_residual(const subject::Subject&) const;
  /// The same for one in which nothing is missing.
  const VectorX& null_residual() const { return null_; }
  /// All patterns that a residual can have (discrepancy.h), white by the uncertainty. Worked out at every call.
  std::shared_ptr<const WhitenedFamilies> whitened_patterns() const;

  /// Root mean square of measured − predicted, translations, m (or rotations alone, rad), of the readings that are not
  /// set aside.
  double rmse(const subject::Subject&) const;
  /// The same at each pose with the tolerances learnt at the others (in ten folds at most).
  double held_out_rmse(const subject::Subject&) const;
  /// Tolerances beyond two declared standard deviations where that subject is right, with them.
  std::vector<std::pair<std::string, double>> strained(const subject::Subject&) const;

  /// The same where what equilibrium in the deformed shape adds to the prediction is that of this subject, and readings
  /// that are gross outliers to it are set aside, unless they are more than one in twenty.
  Observations granted(const subject::Subject&) const;

 private:
  /// Without the zero of the readings, where nobody knows it.
  VectorX from_zero(VectorX residual) const;
  void weigh(const std::vector<bool>& aside);
  void count_shape();

  subject::Subject subject_;
  // Shared by all that grew out of one another.
  std::shared_ptr<const compare::Comparison> comparison_;
  std::shared_ptr<const Families> patterns_;
  int threads_;
  statistics::PartedColumns A_;  // the last of the shared columns: of the deformed shape
  double tolerance_scale_ = 1;
  std::vector<bool> aside_;
  std::shared_ptr<const statistics::Uncertainty> uncertainty_;
  std::optional<compare::HeldOut> held_out_;
  VectorX measured_, shape_, null_;
};

}  // namespace deflect::diagnosis
