// Matrices as sets of columns, each column a direction of the measured numbers.
#pragma once

#include <vector>

#include "msa/base/spatial.h"

namespace deflect::statistics {

/// All of them in one, each with that many rows.
MatrixX side_by_side(const std::vector<MatrixX>&, Eigen::Index rows);

/// Orthonormal columns with the same span. Directions shorter than `threshold` times the longest are none; 0: what
/// rounding can tell.
MatrixX orthonormal(const MatrixX&, double threshold = 0);

}  // namespace deflect::statistics
