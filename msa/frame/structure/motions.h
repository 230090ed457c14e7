// Motions of a structure as columns of a matrix.
#pragma once

#include <vector>

#include "msa/base/spatial.h"

namespace deflect::frame {

/// Combines the columns so that each is 1 in a row in which the others rest: motions come apart. Returns these rows.
std::vector<Eigen::Index> take_apart(MatrixX& U);

}  // namespace deflect::frame
