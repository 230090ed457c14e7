// Dense linear equations with full pivoting in extended arithmetic.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <utility>
#include <vector>

namespace deflect::attack {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;

/// Row by row.
class RealMatrix {
 public:
  RealMatrix(std::size_t rows, std::size_t columns) : rows_(rows), columns_(columns), values_(rows * columns) {}
  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  Real& operator()(std::size_t i, std::size_t j) { return values_[i * columns_ + j]; }
  const Real& operator()(std::size_t i, std::size_t j) const { return values_[i * columns_ + j]; }

 private:
  std::size_t rows_, columns_;
  std::vector<Real> values_;
};

/// P A Q = L U. Pivots below `zero` times the first one are zero: their unknowns are taken as zero.
class FullPivot {
 public:
  FullPivot(RealMatrix A, const Real& zero) : lu_(std::move(A)) {
    const std::size_t n = lu_.rows();
    for (std::size_t i = 0; i < n; ++i) row_.push_back(i), column_.push_back(i);
    Real first = 0;
    for (rank_ = 0; rank_ < n; ++rank_) {
      const Real size = bring_largest(rank_);
      if (rank_ == 0) first = size;
      if (size <= zero * first) break;
      smallest_ = size / first;
      eliminate(rank_);
    }
  }

  std::size_t rank() const { return rank_; }
  /// The last pivot that is not zero, relative to the first.
  double smallest_pivot() const { return static_cast<double>(smallest_); }

  std::vector<Real> solve(const std::vector<Real>& b) const {
    std::vector<Real> y(rank_), x(lu_.rows(), Real(0));
    for (std::size_t i = 0; i < rank_; ++i) {
      y[i] = b[row_[i]];
      for (std::size_t k = 0; k < i; ++k)
        if (lu_(i, k) != 0) y[i] -= lu_(i, k) * y[k];
    }
    for (std::size_t i = rank_; i-- > 0;) {
      for (std::size_t k = i + 1; k < rank_; ++k)
        if (lu_(i, k) != 0) y[i] -= lu_(i, k) * y[k];
      y[i] /= lu_(i, i);
    }
    for (std::size_t i = 0; i < rank_; ++i) x[column_[i]] = y[i];
    return x;
  }

 private:
  /// The largest entry of what is left, brought to (k, k).
  Real bring_largest(std::size_t k) {
    std::size_t r = k, c = k;
    Real size = 0;
    for (std::size_t i = k; i < lu_.rows(); ++i)
      for (std::size_t j = k; j < lu_.rows(); ++j)
        if (lu_(i, j) != 0 && abs(lu_(i, j)) > size) size = abs(lu_(i, j)), r = i, c = j;
    for (std::size_t j = 0; j < lu_.rows(); ++j) std::swap(lu_(r, j), lu_(k, j));
    for (std::size_t i = 0; i < lu_.rows(); ++i) std::swap(lu_(i, c), lu_(i, k));
    std::swap(row_[r], row_[k]);
    std::swap(column_[c], column_[k]);
    return size;
  }

  void eliminate(std::size_t k) {
    for (std::size_t i = k + 1; i < lu_.rows(); ++i) {
      if (lu_(i, k) == 0) continue;
      lu_(i, k) /= lu_(k, k);
      for (std::size_t j = k + 1; j < lu_.rows(); ++j)
        if (lu_(k, j) != 0) lu_(i, j) -= lu_(i, k) * lu_(k, j);
    }
  }

  RealMatrix lu_;
  std::vector<std::size_t> row_, column_;
  std::size_t rank_ = 0;
  Real smallest_ = 1;
};

}  // namespace deflect::attack
