// The likelihood of residuals with a part of the scatter, by groups of rows, known except for its size g:
//   r ~ N(F a, Σ),   Σ = 1 + g ⊕ C_g C_gᵀ + p P Pᵀ,   a unknown ("flat")
// As restricted likelihood, with F projected out and H = [P√p F]ᵀ (1 + g CCᵀ)⁻¹ [P√p F] + diag(1, 0),
//   −2 ln L = χ² + ln |1 + g CCᵀ| + ln |H| + const,   χ² = rᵀ(1 + g CCᵀ)⁻¹r − hᵀH⁻¹h,   h = [P√p F]ᵀ(1 + g CCᵀ)⁻¹ r.
// With C_gᵀC_g = V diag(w) Vᵀ and U = C V w^(−1/2), (1 + g CCᵀ)⁻¹ = (1 − UUᵀ) + U diag(1/(1 + g w)) Uᵀ: only sums of
// squares, so that nothing cancels where a column lies in the span of C. Matrices that depend on g and p have only as
// many rows as C has columns.
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "validation/statistics/parted_columns.h"

namespace deflect::statistics {

class ScaledGroups {
 public:
  /// Directions of C with w not above `least` times the largest are dropped.
  ScaledGroups(const std::vector<GroupColumns>& C, const MatrixX& P, const MatrixX& F, double least);

  /// Sufficient statistics of a residual: inside Uᵀr, along [P F]ᵀ(1 − UUᵀ)r, beside rᵀ(1 − UUᵀ)r.
  struct Seen {
    VectorX inside, along;
    double beside = 0;
  };
  Seen seen(const VectorX& r) const;

  /// At sizes g and p ≥ 0.
  struct Scaled {
    VectorX weight;  // 1/(1 + g w)
    double root_p = 1, log_det = 0;
    Eigen::LLT<MatrixX> H{MatrixX()};  // factorised at once: Eigen leaves info() uninitialised before
  };
  Scaled at(double g, double p) const;
  double chi2(const Scaled&, const Seen&) const;
  double log_likelihood(const Scaled& s, const Seen& r) const { return -0.5 * (chi2(s, r) + s.log_det); }

  /// Reduction of χ² at p = 1 by C with each direction free, F being fitted too, and the number of these directions:
  /// those with w above `least` times the largest.
  struct Gain {
    double gain = 0;
    int freedoms = 0;
  };
  Gain free_gain(const Seen&, double least) const;

 private:
  VectorX factors(double root_p) const;  // of the columns of [P F]

  std::vector<GroupColumns> U_;
  VectorX w_;
  MatrixX PF_, inside_, beside_;  // UᵀPF; (PF)ᵀ(1 − UUᵀ)PF
  Eigen::Index flat_ = 0;
};

}  // namespace deflect::statistics
