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

/// What few of the columns span, chosen in turn: at each step the column that takes most of the vector beside the ones
/// before, as long as that takes more than `least` off its squared length. Orthonormal; columns of which less than
/// `threshold` is left beside the ones before are passed over. Source: orthogonal matching pursuit, Y. C. Pati, R.
/// Rezaiifar, P. S. Krishnaprasad, Asilomar Conference 1993.
MatrixX chosen_in_turn(MatrixX columns, VectorX explained, double least, double threshold);

}  // namespace deflect::statistics
