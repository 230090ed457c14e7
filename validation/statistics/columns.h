// Matrices as sets of columns; each column is a vector over the measured numbers.
#pragma once

#include <vector>

#include "msa/base/spatial.h"

namespace deflect::statistics {

/// All matrices in one, next to each other; each has `rows` rows.
MatrixX side_by_side(const std::vector<MatrixX>&, Eigen::Index rows);

/// Orthonormal columns with the same span. Directions shorter than `threshold` times the longest are dropped; 0: the
/// default threshold for rounding.
MatrixX orthonormal(const MatrixX&, double threshold = 0);

}  // namespace deflect::statistics
