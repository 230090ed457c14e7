// Corrections of recorded channels and loads (channel_mistakes.h), tried on the prediction before a whole comparison.
#pragma once

#include <optional>
#include <vector>

#include "validation/compare/comparison.h"
#include "validation/recording/recorded.h"

namespace deflect::compare {

/// The loss of measured y against predicted p is the mean of ln(1 + ((y − p)/s)²), with s² = σ² + (1 % of the channel's
/// root mean square prediction)²: numbers far off count little.
class ChannelScreen {
 public:
  /// Both must outlive it.
  ChannelScreen(const subject::Subject&, const Comparison&, int threads);

  double loss(const recording::Correction&) const;
  /// The same by linear geometry, with what the true one adds under the loads as recorded: far quicker. Nothing where
  /// it is no estimate: where loads stay, or the subject is linear.
  std::optional<double> estimated_loss(const recording::Correction&) const;
  /// Whether each channel that the correction scales follows its prediction then: with corrected z, predicted p and
  /// expected deviations e,
  ///   Σ (p² − (z − p)²)/e² > 30, and Σ z p/e² / Σ z²/e², the factor that would fit best, from 1/2 to 2;
  /// z and p from their means where the zero is free.
  /// Else the prediction is nothing, nearly, and any correction that makes nothing of the readings would fit: readings
  /// of a hundredth of another channel are not in µm.
  bool follows(const recording::Correction&) const;
  /// What the channel that holds most of the misfit may show in place of its own quantity, each with the mean of χ² of
  /// the channel's numbers then, for which 1 % of what it would read may be off beside noise and tolerances. Those that
  /// leave less than 1/36 of it and that the readings follow beyond chance; none where no channel holds four fifths.
  std::vector<std::pair<recording::Correction, double>> other_quantities(const Comparison&) const;
  /// A correction is promising with a loss below this: it takes away 40 % of what is beyond noise and tolerances.
  double promising() const { return promising_; }
  /// It may be promising where its estimate is below this: half of that.
  double estimated_promising() const { return (as_recorded_ + promising_) / 2; }
  /// Losses that differ by less are alike.
  double equal_within() const { return equal_within_; }

 private:
  bool follows(std::size_t channel, double factor) const;
  bool has_other_loads(const measurement::Measurements&) const;
  double loss(const measurement::Measurements&, const std::vector<VectorX>& predicted) const;

  const subject::Subject& subject_;
  const ResidualStudy* study_;
  int threads_;
  std::vector<double> scale_;   // by channel
  VectorX deviation_;           // expected, by measured number
  std::vector<VectorX> shape_;  // what the true geometry adds, by reading; empty where the subject is linear
  double as_recorded_ = 0, promising_ = 0, equal_within_ = 0;  // as_recorded_: loss
};

}  // namespace deflect::compare
