// A first look at corrections of recorded data, on some of the readings: what each leaves of the misfit.
#pragma once

#include <optional>
#include <vector>

#include "validation/compare/comparison.h"
#include "validation/compare/recorded.h"

namespace deflect {

/// The loss is the mean of ln(1 + z²) over measured numbers, z what measured and predicted differ by, against a
/// hundredth of what is usually measured and two hundredths of the prediction: gross outliers count little, small
/// displacements as much as large ones. Corrected loads move the prediction by the tangent compliance.
class CorrectionScreen {
 public:
  /// All must outlive it.
  CorrectionScreen(const Mechanism&, const Comparison&, int threads);

  double as_recorded() const { return as_recorded_; }
  /// Below this a correction takes a good part away of what noise does not explain.
  double promising() const { return promising_; }

  /// Of a correction of displacements and loads.
  double loss(const Correction&) const;
  /// Of any: with the prediction at the corrected poses; infinite where the machine does not reach them.
  double loss_elsewhere(const Correction&) const;
  /// The shift of all poses along an axis of the base that leaves least, 0.5 mm or more.
  std::optional<Correction> best_shift(int axis) const;

 private:
  double loss(const Measurements&, const std::vector<Vector6>& predicted) const;
  std::optional<std::vector<Vector6>> predicted_with(const Correction&) const;

  const Mechanism* mechanism_;
  const ResidualStudy* study_;
  int threads_;
  Measurements sample_;
  std::vector<std::size_t> rows_;  // readings of the study that are in the sample
  double size_ = 1;                // m: of the machine
  double as_recorded_ = 0, promising_ = 0;
};

}  // namespace deflect
