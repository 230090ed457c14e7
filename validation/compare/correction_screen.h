// A quick test of corrections of recorded data on a sample of the readings: how much of the misfit each leaves.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "validation/compare/comparison.h"
#include "validation/recording/recorded.h"

namespace deflect::compare {

/// The loss is the mean of ln(1 + z²) + ln(s/|f|) over the measured numbers, with z = (measured − predicted)/s and f
/// the correction's factor. It is the negative log-density of the numbers as recorded under a Cauchy distribution, up
/// to constants, so that gross outliers count little. The scale s is √(σ² + (0.5 % of a typical measured number)² + (1
/// % of the prediction)²); typical is the upper quartile. Corrected loads change the prediction by the tangent
/// compliance. Only readings of the displacement of T count, not those of named sensors.
class CorrectionScreen {
 public:
  /// The comparison must outlive it.
  CorrectionScreen(const subject::Subject&, const Comparison&, int threads);

  double as_recorded() const { return as_recorded_; }
  /// A correction with a smaller loss removes a good part of what noise does not explain.
  double promising() const { return promising_; }
  /// Losses that differ by less do not show which correction is right.
  double equal_within() const { return equal_within_; }

  /// Loss of a correction of displacements and loads.
  double loss(const recording::Correction&) const;
  /// Loss of any correction, with predictions at the corrected poses; infinite where the machine cannot reach them.
  double loss_elsewhere(const recording::Correction&) const;
  /// The shift of all poses along a base axis with the least loss, if it is 0.5 mm or more.
  std::optional<recording::Correction> best_shift(int axis) const;
  /// A point of application with what it leaves.
  struct BestPoint {
    recording::Correction correction;
    double loss = 0;
    bool leaves_noise = false;  ///< noise and tolerances alone, to the first order: the loss does not know tolerances
  };
  /// The common point p of application of all forces, if it is more than 1 mm from T: moments about T are then M + p ×
  /// f. The loss shows which readings are gross outliers; the others give p, weighed by noise and tolerances.
  std::optional<BestPoint> best_point() const;

 private:
  /// A measured number minus its prediction; rotations times the machine's size.
  struct Difference {
    std::size_t row, component;
    double left, scale;
  };
  std::vector<Difference> differences(const measurement::Measurements&, const std::vector<VectorX>& predicted) const;
  double loss(const measurement::Measurements&, const std::vector<VectorX>& predicted,
              const recording::Rewritten& displacement) const;
  std::optional<std::vector<VectorX>> predicted_with(const recording::Correction&) const;
  /// The point with the least loss.
  std::optional<Vector3> point_of_least_loss() const;
  struct Point {
    Vector3 p;
    double more_if_it_turns;  ///< χ² that one in platform axes (the effect moved@load) explains more
    bool leaves_noise;        ///< with it noise and tolerances are left, to the first order
  };
  /// The point by generalised least squares, without the readings that are gross outliers with the point p.
  Point weighed_point(const Vector3& p) const;

  subject::Subject subject_;
  const Comparison* comparison_;
  const ResidualStudy* study_;
  int threads_;
  measurement::Measurements sample_;
  std::vector<std::size_t> rows_;  // readings of the study that are in the sample
  double size_ = 1;                // m: of the machine
  std::array<double, 2> sigma_{};  // m, rad: for readings without σ
  double as_recorded_ = 0, promising_ = 0, equal_within_ = 0;
};

}  // namespace deflect::compare
