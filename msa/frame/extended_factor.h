// A dense Cholesky factor with extended digits, for the few structures whose stiffnesses leave the sparse one none.
#pragma once

#include "msa/frame/elimination.h"

namespace deflect::frame {

/// TᵀKT, assembled element by element and factored in long double after scaling its diagonal to 1. Costs n³/6
/// operations: for up to most_freedoms.
class ExtendedFactor {
 public:
  static constexpr int most_freedoms = 1000;

  ExtendedFactor(const Model&, const Elimination&, const VectorX& spring_tangents);

  /// A pivot was not positive: there is nothing to solve with.
  bool failed() const { return failed_; }
  VectorX solve(const VectorX& f) const;

 private:
  using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  Matrix L_;
  Vector scale_;
  bool failed_ = false;
};

}  // namespace deflect::frame
