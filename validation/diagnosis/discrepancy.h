// A structured discrepancy: what is left of a residual, r ~ N(0, 1 + τ² B Bᵀ), B a family of patterns, of length √n
// each:
//   sites  all patterns that `compare` knows, site by site where they lie in sites;
//   poses  at each pose a displacement and a compliance of its own;
//   loads  displacements by kinks, steps, squares and products of the load's components, by powers of time and
//          temperature.
// Nothing is said of how the patterns come about.
#pragma once

#include "validation/compare/comparison.h"

namespace deflect {

/// One matrix per family, columns over the measured numbers, m and rad per unit of each pattern.
using Families = std::vector<MatrixX>;
Families discrepancy_families(const ResidualStudy&);

class Discrepancy {
 public:
  /// Whitened. What `fitted` (whitened too) spans is taken out of the patterns, which keep their size.
  explicit Discrepancy(const Families&, const MatrixX& fitted = {});

  /// ln of the evidence against "nothing": mean over the families and over τ, spread evenly in ln τ from 1e-3 to 10:
  /// none is too small to be one.
  double log_evidence(const VectorX& r) const;
  /// Of as much of r in the patterns of some family by chance.
  double p_value(const VectorX& r) const;

  /// The family and size that r speaks for.
  struct Size {
    std::size_t family = 0;
    double tau = 0;
  };
  Size likeliest(const VectorX& r) const;
  /// (1 + τ² B Bᵀ)^(−1/2) r: with it the discrepancy is one more nuisance.
  VectorX whitened(const VectorX& r, const Size&) const;

 private:
  struct Family {
    MatrixX Q;  // orthonormal, BBᵀ = Q diag(w) Qᵀ
    VectorX w;
  };
  static std::vector<double> log_likelihoods(const Family&, const VectorX& r);  // by scale

  std::vector<Family> families_;
};

}  // namespace deflect
