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

/// The pattern is analysed once (ordering, symbolic analysis); values and right-hand sides can change many times.
class SparseCholesky {
 public:
  explicit SparseCholesky(const SparsePattern&);
  ~SparseCholesky();
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;

  /// Factors S K S with S = diag(K)^-½, so that the result does not depend on units. Returns the reciprocal condition
  /// estimate of the scaled matrix from the factor's diagonal; 0 where a diagonal entry or a pivot is not positive;
  /// solve() must not be called then.
  double factor(const std::vector<double>& values);

  /// The smallest eigenvalue of the factored S K S, and its motion in the freedoms of K, by inverse iteration from
  /// fixed start vectors. It is an upper bound, within a factor of a few. A singular K with rounding gives less than n
  /// ε, whatever its pivots.
  struct Softest {
    double eigenvalue = 0;
    VectorX motion;
  };
  Softest softest() const;

  /// Solves K X = B.
  MatrixX solve(const MatrixX& B) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace deflect::frame
