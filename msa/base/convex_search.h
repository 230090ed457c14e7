// The least value of a convex function of few variables between bounds, by an active set.
//
//   f(x) = ½ Σ a_j x_j² − bᵀx + Σ φ_i(y_i),   y = e + B x,   low_i ≤ y_i ≤ high_i
//
// with a ≥ 0 and φ_i convex and once continuously differentiable. In each round the search goes to the least value on
// the bounds that are active (Newton, the length of a step by an exact line search), stops at the first bound on the
// way and makes it active, or lets go one that pushes the wrong way. f falls in every round but those of length zero,
// where the bound of the least index is taken (Bland), so that no set of bounds returns: the search ends wherever the
// φ_i consist of finitely many parabolas, and converges as Newton's method does on others.
// Source: J. Nocedal, S. Wright, Numerical Optimization, 2006, §16.5, for curvatures that may be zero.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "msa/base/spatial.h"

namespace deflect {

inline constexpr double infinite = std::numeric_limits<double>::infinity();

struct ConvexRow {
  double low = 0, high = 0;                        ///< of y; may be infinite
  std::function<double(double)> slope, curvature;  ///< φ' and φ'' at y
};

struct ConvexProblem {
  VectorX a, b;
  MatrixX B;
  VectorX e;
  std::vector<ConvexRow> rows;
  double rounding = 0;  ///< of b and of slopes by rows, where these are known to no better; smaller ones are zero
};

struct ConvexAnswer {
  enum class Outcome { least, unbounded, undecided };
  Outcome outcome = Outcome::undecided;
  VectorX x, y;
  VectorX push;           ///< by row: what its bound adds to φ'; > 0 at the upper one
  std::vector<int> side;  ///< by row: −1 and 1 at its bounds, where they are active, otherwise 0
  VectorX along;          ///< unbounded: by how much y changes along the way on which f falls for ever
};

/// From a point x between the bounds.
ConvexAnswer least(const ConvexProblem&, const VectorX& x);

}  // namespace deflect
