// Motions of a structure as columns of a matrix.
#pragma once

#include <vector>

#include "msa/base/spatial.h"

namespace deflect::frame {

/// Separates motions: combines the columns so that each is 1 in a row where the others are 0. Returns these rows.
std::vector<Eigen::Index> take_apart(MatrixX& U);

}  // namespace deflect::frame
