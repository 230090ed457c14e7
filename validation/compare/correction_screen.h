// A first look at corrections of recorded data, on some of the readings: what each leaves of the misfit.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "validation/compare/comparison.h"
#include "validation/recording/recorded.h"

namespace deflect::compare {

/// The loss is the mean of ln(1 + z²) + ln(s/|f|) over measured numbers: z what measured and predicted differ by, over
/// a scale s; f the factor of the correction, so that it is about the density of the numbers as they were recorded (of
/// Cauchy's form: gross outliers count little). s is the root of the squares of σ, of half a hundredth of what is
/// usually measured and of a hundredth of the prediction. Corrected loads move the prediction by the tangent
/// compliance.
class CorrectionScreen {
 public:
  /// All must outlive it.
  CorrectionScreen(const subject::Subject&, const Comparison&, int threads);

  double as_recorded() const { return as_recorded_; }
  /// Below this a correction takes a good part away of what noise does not explain.
  double promising() const { return promising_; }
  /// Losses that differ by less say nothing of which correction is right.
  double equal_within() const { return equal_within_; }

  /// Of a correction of displacements and loads.
  double loss(const recording::Correction&) const;
  /// Of any: with the prediction at the corrected poses; infinite where the machine does not reach them.
  double loss_elsewhere(const recording::Correction&) const;
  /// The shift of all poses along an axis of the base that leaves least, 0.5 mm or more.
  std::optional<recording::Correction> best_shift(int axis) const;
  /// The one point at which all forces act that leaves least, more than 1 mm from T: moments about T are then M + p ×
  /// f.
  std::optional<recording::Correction> best_point() const;

 private:
  /// A measured number against its prediction; rotations times the machine's size.
  struct Difference {
    std::size_t row, component;
    double left, scale;
  };
  std::vector<Difference> differences(const measurement::Measurements&, const std::vector<Vector6>& predicted) const;
  double loss(const measurement::Measurements&, const std::vector<Vector6>& predicted,
              const recording::Rewritten& displacement) const;
  std::optional<std::vector<Vector6>> predicted_with(const recording::Correction&) const;

  subject::Subject subject_;
  const ResidualStudy* study_;
  int threads_;
  measurement::Measurements sample_;
  std::vector<std::size_t> rows_;  // readings of the study that are in the sample
  double size_ = 1;                // m: of the machine
  std::array<double, 2> sigma_{};  // m, rad: of readings that do not say it
  double as_recorded_ = 0, promising_ = 0, equal_within_ = 0;
};

}  // namespace deflect::compare
