// A structured discrepancy: what is left of a residual, r ~ N(0, 1 + τ² B Bᵀ), B all patterns that `compare` knows,
// site by site where they lie in sites, of length √n each. Nothing is said of how the patterns come about.
#pragma once

#include "validation/compare/comparison.h"

namespace deflect {

/// Columns over the measured numbers, m and rad per unit of each pattern.
MatrixX discrepancy_columns(const ResidualStudy&);

class Discrepancy {
 public:
  /// `columns`: whitened. What `fitted` (whitened too) spans is taken out of the patterns, which keep their size.
  explicit Discrepancy(const MatrixX& columns, const MatrixX& fitted = {});

  /// ln of the evidence against "nothing", τ spread evenly in ln τ from 1e-3 to 10: none is too small to be one.
  double log_evidence(const VectorX& r) const;
  double likeliest_scale(const VectorX& r) const;  ///< τ
  /// Of as much of r in the patterns by chance.
  double p_value(const VectorX& r) const;
  /// (1 + τ² B Bᵀ)^(−1/2) r: with it the discrepancy is one more nuisance.
  VectorX whitened(const VectorX& r, double tau) const;

 private:
  std::vector<double> log_likelihoods(const VectorX& r) const;  // by scale

  MatrixX Q_;  // orthonormal, BBᵀ = Q diag(w) Qᵀ
  VectorX w_;
};

}  // namespace deflect
