// What is off in one reading alone: errors of the recorded loads, and where in open play the machine stands.
//
// A row combines loads (measurement::loads_of_row). Each was weighed, or pulled by a jack, on its own and has an error
// of its own, L_c (1 + t u_c) with u_c ~ N(0, 1); the components of a load at one point share it. To the first order a
// reading f(L) is then off by
//   t Σ_c p_c u_c,   p_c = L_c ∂f/∂L_c,   cov = t² Σ_c p_c p_cᵀ.
// Of one load p_c is taken as the whole prediction d, so that cov = t² d dᵀ. Of several the p_c are differences of the
// prediction in linear geometry; what they leave of d (the deformed shape, laws that are not linear, what is there
// without a load) is shared in each channel by their sizes. So Σ_c p_c = d: were all loads off by one factor, that of
// a single load would be left. Where nothing stands in linear geometry, one factor is taken for all loads of a reading.
#pragma once

#include <vector>

#include "validation/measurement/replicates.h"
#include "validation/subject/subject.h"

namespace deflect::statistics {

class LoadErrors {
 public:
  LoadErrors() = default;
  /// `predicted`: the readings of all channels (Standing::predict) of this subject, which stands at `standing`.
  LoadErrors(const subject::Subject&, const subject::Standing&, const measurement::Measurements&,
             const std::vector<VectorX>& predicted);
  /// All loads of a reading off by one factor. `t`: its relative standard deviation.
  LoadErrors(double t, const std::vector<VectorX>& predicted);

  /// A copy with these errors of play beside those of loads (open_play.h); empty: without any.
  LoadErrors with_play(const std::vector<MatrixX>&) const;
  /// Readings with errors of play.
  std::size_t readings_in_play() const;

  /// Channels × loads of a reading, or one column where it has none: t p_c; behind them those of play.
  const MatrixX& of(std::size_t reading) const { return columns_[reading]; }
  /// Channels × columns, by reading; empty: none.
  const std::vector<MatrixX>& of_play() const { return play_; }
  /// Standard deviations of measured numbers.
  double deviation(const measurement::MeasuredValue&) const;
  VectorX deviations(const std::vector<measurement::MeasuredValue>&) const;

 private:
  std::vector<MatrixX> columns_, play_;
};

/// σ of the noise in what scatters by so much, where errors of the loads, of this mean square, scatter too: what they
/// share of the variance is taken off, up to nine tenths.
double noise_beside_loads(double scatter, double mean_square);

/// The same for the σ that replicates tell, by the loads of the replicates.
void take_off_load_errors(std::vector<measurement::MeasuredValue>&, const LoadErrors&,
                          const measurement::Measurements&);

}  // namespace deflect::statistics
