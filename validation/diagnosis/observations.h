// What a diagnosis has to explain: the measured numbers with all that is known of their scatter.
#pragma once

#include "validation/compare/comparison.h"

namespace deflect {

/// A comparison, its uncertainty kept, and predictions asked for again and again.
class Observations {
 public:
  Observations(const Mechanism&, const Measurements&, const ComparisonOptions&);

  const Mechanism& device() const { return *device_; }
  const Comparison& comparison() const { return comparison_; }
  const Uncertainty& uncertainty() const { return uncertainty_; }
  std::size_t numbers() const { return uncertainty_.count(); }

  /// Measured − predicted, m and rad, of a device: as below.
  VectorX residual(const Mechanism&) const;
  /// Σ^(−1/2) (measured − predicted) of a device, small displacements, the deformed shape's share added (see below).
  VectorX whitened_residual(const Mechanism&) const;
  /// The same for a device in which nothing is missing.
  const VectorX& null_residual() const { return null_; }

  /// Root mean square of measured − predicted, translations, m.
  double rmse(const Mechanism&) const;
  /// The same at each pose with the tolerances learnt at the others (in ten folds at most).
  double held_out_rmse(const Mechanism&) const;
  /// Tolerances beyond two prior standard deviations where that device is right, with them.
  std::vector<std::pair<std::string, double>> strained(const Mechanism&) const;

  /// What equilibrium in the deformed shape adds to the prediction, as of this device, from now on.
  void take_deformed_shape_of(const Mechanism&);

 private:
  const Mechanism* device_;
  Comparison comparison_;
  Uncertainty uncertainty_;
  VectorX measured_, shape_, null_;
};

}  // namespace deflect
