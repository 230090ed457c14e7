// The likelihood of residuals some of whose scatter, of groups of rows, is known but for its size:
//   r ~ N(F a, Σ),   Σ = 1 + g ⊕ C_g C_gᵀ + p P Pᵀ,   a unknown ("flat")
// with F taken out (restricted likelihood): with H = [P√p F]ᵀ (1 + g CCᵀ)⁻¹ [P√p F] + diag(1, 0),
//   −2 ln L = χ² + ln |1 + g CCᵀ| + ln |H| + const,   χ² = rᵀ(1 + g CCᵀ)⁻¹r − hᵀH⁻¹h,   h = [P√p F]ᵀ(1 + g CCᵀ)⁻¹ r.
// With C_gᵀC_g = V diag(w) Vᵀ and U = C V w^(−1/2), (1 + g CCᵀ)⁻¹ = (1 − UUᵀ) + U diag(1/(1 + g w)) Uᵀ: sums of squares
// throughout, nothing cancels where a column lies in the span of C. What depends on g and p has as many rows as C has
// columns.
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "validation/statistics/parted_columns.h"

namespace deflect::statistics {

class ScaledGroups {
 public:
  /// Directions of C whose w is not more than `least` times the largest are none.
  ScaledGroups(const std::vector<GroupColumns>& C, const MatrixX& P, const MatrixX& F, double least);

  /// All that counts of a residual: in U, beside it, and along [P F] beside it.
  struct Seen {
    VectorX inside, along;
    double beside = 0;
  };
  Seen seen(const VectorX& r) const;

  /// At sizes g and p ≥ 0.
  struct Scaled {
    VectorX weight;  // 1/(1 + g w)
    double root_p = 1, log_det = 0;
    Eigen::LLT<MatrixX> H;
  };
  Scaled at(double g, double p) const;
  double chi2(const Scaled&, const Seen&) const;
  double log_likelihood(const Scaled& s, const Seen& r) const { return -0.5 * (chi2(s, r) + s.log_det); }

  /// What C takes off χ² at p = 1 where its size is free, with the number of its own directions: those whose w is more
  /// than `least` times the largest, beside F.
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
