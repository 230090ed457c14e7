// Distance of a point from the convex hull of others.
#pragma once

#include "msa/base/spatial.h"

namespace deflect::validity {

/// The point of the convex hull of the columns of X that is nearest to q:
///   min ‖X w − q‖,   w ≥ 0,   Σ w = 1,
/// by non-negative least squares with Σ w = 1 as one more row of large weight (C. Lawson, R. Hanson, Solving Least
/// Squares Problems, 1974, ch. 23). At least one column.
VectorX nearest_in_hull(const MatrixX& X, const VectorX& q);

}  // namespace deflect::validity
