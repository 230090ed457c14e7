// Sparse Cholesky factorisation of symmetric positive definite matrices. Hides CHOLMOD.
#pragma once

#include <memory>
#include <vector>

#include "msa/base/spatial.h"

namespace deflect::frame {

/// Lower triangle of a symmetric matrix by columns, rows ascending, the diagonal present in every column.
struct SparsePattern {
  int n = 0;
  std::vector<int> column_start;  ///< n + 1
  std::vector<int> row;
};

/// Pattern once (ordering, symbolic analysis), values many times, right-hand sides many times.
class SparseCholesky {
 public:
  explicit SparseCholesky(const SparsePattern&);
  ~SparseCholesky();
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;

  /// Factors S K S with S = diag(K)^-½, so that the verdict does not depend on units. Returns the reciprocal condition
  /// estimate of the scaled matrix from the factor's diagonal; 0 where a diagonal or a pivot is not positive, and then
  /// there is no factor to solve with.
  double factor(const std::vector<double>& values);

  /// The smallest eigenvalue of what was factored, S K S, and its motion in K's own freedoms, by inverse iteration from
  /// fixed starts. An upper bound that is sharp to a factor of a few. A singular K, rounded, gives less than n ε,
  /// whatever its pivots look like.
  struct Softest {
    double eigenvalue = 0;
    VectorX motion;
  };
  Softest softest() const;

  /// K X = B.
  MatrixX solve(const MatrixX& B) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace deflect::frame
