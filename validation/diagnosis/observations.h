// What a diagnosis has to explain: the measured numbers with all that is known of their scatter.
#pragma once

#include <optional>

#include "validation/compare/comparison.h"
#include "validation/compare/held_out.h"
#include "validation/diagnosis/discrepancy.h"

namespace deflect {

/// A comparison, its uncertainty kept, and predictions asked for again and again. Tolerances count as large as the
/// data say where they look larger than declared (Uncertainty::scale_of_tolerances); what equilibrium in the deformed
/// shape adds is known to a fifth of it, one more nuisance.
class Observations {
 public:
  Observations(const Mechanism&, const Measurements&, const ComparisonOptions&);
  Observations(const Observations&) = delete;
  Observations& operator=(const Observations&) = delete;

  const Mechanism& device() const { return *device_; }
  const Comparison& comparison() const { return comparison_; }
  const Uncertainty& uncertainty() const { return uncertainty_; }
  std::size_t numbers() const { return uncertainty_.count(); }
  double tolerance_scale() const { return tolerance_scale_; }
  std::size_t set_aside() const;  ///< readings

  /// Measured − predicted, m and rad, of a device, small displacements, the deformed shape's share added (see below).
  VectorX residual(const Mechanism&) const;
  /// Σ^(−1/2) of it.
  VectorX whitened_residual(const Mechanism&) const;
  /// The same for a device in which nothing is missing.
  const VectorX& null_residual() const { return null_; }
  /// All patterns that a residual can have (discrepancy.h), white by the uncertainty as it is now.
  std::shared_ptr<const WhitenedFamilies> whitened_patterns();

  /// Root mean square of measured − predicted, translations, m (or rotations alone, rad), of the readings that are not
  /// set aside.
  double rmse(const Mechanism&) const;
  /// The same at each pose with the tolerances learnt at the others (in ten folds at most).
  double held_out_rmse(const Mechanism&) const;
  /// Tolerances beyond two declared standard deviations where that device is right, with them.
  std::vector<std::pair<std::string, double>> strained(const Mechanism&) const;

  /// From now on what equilibrium in the deformed shape adds to the prediction is that of this device, and readings
  /// that are gross outliers to it are set aside, unless they are more than one in twenty.
  void take_for_granted(const Mechanism&);

 private:
  void weigh(const std::vector<bool>& aside);
  void count_shape();

  const Mechanism* device_;
  Comparison comparison_;
  Families patterns_;
  std::shared_ptr<const WhitenedFamilies> whitened_patterns_;  // made when first asked for
  int threads_;
  PartedColumns A_;  // the last of the shared columns: of the deformed shape
  double tolerance_scale_ = 1;
  std::vector<bool> aside_;
  Uncertainty uncertainty_;
  std::optional<HeldOut> held_out_;
  VectorX measured_, shape_, null_;
};

}  // namespace deflect
