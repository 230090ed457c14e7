// Rectangular linear equations with full pivoting: rank, null space, particular solutions.
#pragma once

#include <algorithm>

#include "tests/attack/full_pivot.h"

namespace deflect::attack {

/// Gauss–Jordan on [A | B], pivots in A only. A pivot below `zero` times the first is none.
class Echelon {
 public:
  Echelon(RealMatrix AB, std::size_t columns, const Real& zero) : a_(std::move(AB)), columns_(columns) {
    Real first = 0;
    for (std::size_t k = 0; k < std::min(a_.rows(), columns_); ++k) {
      const auto [r, c, size] = largest(k);
      if (k == 0) first = size;
      if (size == 0) break;
      if (size <= zero * first) {
        left_ = size / first;
        break;
      }
      taken_ = std::min(taken_, Real(size / first));
      for (std::size_t j = 0; j < a_.columns(); ++j) std::swap(a_(r, j), a_(k, j));
      pivots_.push_back(c);
      clear(k, c);
    }
  }

  std::size_t rank() const { return pivots_.size(); }
  Real smallest_taken() const { return taken_; }  ///< of the pivots, over the first
  Real largest_left() const { return left_; }     ///< of what would have been the next
  /// The largest entry of B in rows without pivot: what no solution reaches.
  Real left_over() const {
    Real out = 0;
    for (std::size_t i = rank(); i < a_.rows(); ++i)
      for (std::size_t j = columns_; j < a_.columns(); ++j) out = std::max(out, Real(abs(a_(i, j))));
    return out;
  }

  /// A x = B's column, unknowns without pivot zero.
  std::vector<Real> particular(std::size_t column) const {
    std::vector<Real> x(columns_, Real(0));
    for (std::size_t i = 0; i < rank(); ++i) x[pivots_[i]] = a_(i, columns_ + column);
    return x;
  }

  std::vector<std::vector<Real>> null_space() const {
    std::vector<std::vector<Real>> out;
    for (std::size_t c = 0; c < columns_; ++c) {
      if (taken(c)) continue;
      std::vector<Real> x(columns_, Real(0));
      x[c] = 1;
      for (std::size_t i = 0; i < rank(); ++i) x[pivots_[i]] = -a_(i, c);
      out.push_back(std::move(x));
    }
    return out;
  }

 private:
  struct Entry {
    std::size_t row, column;
    Real size;
  };

  bool taken(std::size_t c) const { return std::find(pivots_.begin(), pivots_.end(), c) != pivots_.end(); }

  Entry largest(std::size_t k) const {
    Entry out{k, 0, 0};
    for (std::size_t c = 0; c < columns_; ++c) {
      if (taken(c)) continue;
      for (std::size_t r = k; r < a_.rows(); ++r)
        if (a_(r, c) != 0 && abs(a_(r, c)) > out.size) out = {r, c, abs(a_(r, c))};
    }
    return out;
  }

  void clear(std::size_t k, std::size_t c) {
    const Real pivot = a_(k, c);
    for (std::size_t j = 0; j < a_.columns(); ++j)
      if (a_(k, j) != 0) a_(k, j) /= pivot;
    for (std::size_t i = 0; i < a_.rows(); ++i) {
      if (i == k || a_(i, c) == 0) continue;
      const Real factor = a_(i, c);
      for (std::size_t j = 0; j < a_.columns(); ++j)
        if (a_(k, j) != 0) a_(i, j) -= factor * a_(k, j);
    }
  }

  RealMatrix a_;
  std::size_t columns_;
  std::vector<std::size_t> pivots_;
  Real taken_ = 1, left_ = 0;
};

}  // namespace deflect::attack
