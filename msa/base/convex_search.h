// Minimises a convex function of few variables subject to bounds, by an active-set method.
//
//   f(x) = ½ Σ a_j x_j² − bᵀx + Σ φ_i(y_i),   y = e + B x,   low_i ≤ y_i ≤ high_i
//
// with a ≥ 0 and φ_i convex and once continuously differentiable. Each round moves towards the minimum on the active
// bounds (Newton's method with an exact line search). It stops at the first bound on the way and makes it active, or
// releases a bound whose multiplier has the wrong sign. f decreases in every round except those of length zero. There
// the bound of least index is taken (Bland's rule), so that no active set repeats. The search ends where the φ_i
// consist of finitely many parabolas, and converges like Newton's method for others. Source: J. Nocedal, S. Wright,
// Numerical Optimization, 2006, §16.5, for curvatures that may be zero.
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
  double rounding = 0;  ///< accuracy of b and of the slopes; smaller values count as zero
};

struct ConvexAnswer {
  enum class Outcome { least, unbounded, undecided };
  Outcome outcome = Outcome::undecided;
  VectorX x, y;
  VectorX push;           ///< by row: multiplier that its bound adds to φ'; > 0 at the upper bound
  std::vector<int> side;  ///< by row: −1 or 1 where the lower or upper bound is active, else 0
  VectorX along;          ///< unbounded: change of y along the direction in which f decreases without end
};

/// Starts at a point x within the bounds, on those that `sides` (by row, as in ConvexAnswer) names.
ConvexAnswer least(const ConvexProblem&, const VectorX& x, const std::vector<int>& sides = {});

}  // namespace deflect
