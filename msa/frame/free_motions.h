// Motions that nothing resists: near null vectors of the stiffness that strain no element.
#pragma once

#include <vector>

#include "msa/frame/elimination.h"
#include "msa/frame/sparse_cholesky.h"

namespace deflect::frame {

/// Motions u (columns, by freedom; the largest translation, or rotation times the structure's size, is 1) that the
/// reduced stiffness `values` resists with less than 1e-11 of its scale, by shifted block inverse iteration on the
/// Jacobi-scaled matrix. All of them, those that strain a soft element beside very stiff ones included.
MatrixX soft_motions(const Model&, const Elimination&, const SparsePattern&, const std::vector<double>& values);

/// Of those, combinations that strain no element, whatever its stiffness: what the structure can do for nothing.
MatrixX unstrained(const Model&, const MatrixX& motions);

/// Strain energy of a motion in each part, every element scaled to the energy that a motion of size 1 of one of its
/// ends could store; by beam, then by spring.
VectorX strain_of(const Model&, const VectorX& u);

/// u divided by its size.
VectorX normalised(const Model&, VectorX u);

}  // namespace deflect::frame
