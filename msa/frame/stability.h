// Why a structure cannot stand: which parts move, and how, with nothing to resist.
#pragma once

#include <vector>

#include "msa/frame/elimination.h"
#include "msa/frame/sparse_cholesky.h"

namespace deflect::frame {

/// Motions u (columns, by freedom, largest translation or rotation 1) that the reduced stiffness `values` resists with
/// less than 1e-11 of its scale: near null vectors of the Jacobi-scaled matrix by shifted block inverse iteration.
/// At most `limit` are returned.
MatrixX free_motions(const Model&, const Elimination&, const SparsePattern&, const std::vector<double>& values,
                     int limit = 8);

/// Throws ModelError that names each free motion by the node that moves most and its direction; returns when there is
/// none (the matrix is merely ill-conditioned).
void refuse_mechanism(const Model&, const Elimination&, const SparsePattern&, const std::vector<double>& values);

}  // namespace deflect::frame
