// The displacements of a frame by another way than the program's, in 50 digits.
//
// Members by the force method: member_flexibility.h gives the flexibility C of the clamped member for the forces q at
// its end b. Releases leave those q that do not carry a released component at either end, q = Q s; the member's
// stiffness at its nodes is Bᵀ Q (Qᵀ C Q)⁻¹ Qᵀ B, where B u is the motion of end b seen from the body of end a, in
// member axes.
//
// Constraints and links by Lagrange's multipliers λ:
//   | K  Gᵀ | |u|   |f|
//   | G  0  | |λ| = |0|
// one dense matrix, factorised with full pivoting (freedoms scaled by 1/√K_ii, rows of G by their largest entry); the
// pivots of redundant constraints are zero.
#pragma once

#include <vector>

#include "msa/frame/file/frame_description.h"

namespace deflect::attack {

struct DenseCase {
  std::vector<Vector6> displacements;  ///< by node: m, rad
  std::vector<Vector6> ends;           ///< by member: q above, N and Nm
};

struct DenseSolution {
  std::vector<DenseCase> cases;
  /// κ = ‖D K D‖₁ ‖D⁻¹ F D⁻¹‖₁, D = diag(1/√K_ii), F the flexibility of the constrained frame: by how much relative
  /// errors of the assembled stiffness may grow in the displacements.
  double condition = 1;
  /// Largest displacement that a load of the size of the given ones can make anywhere; m, rotations times the extent.
  double largest_response = 0;
};

/// `held`: freedoms of nodes (6 · node + freedom) that are held beside the supports, so that idle motions rest.
DenseSolution solve_dense(const frame::FrameDescription&, const std::vector<int>& held);

/// The frame's extent, by which rotations weigh against translations, m.
double extent(const frame::FrameDescription&);

}  // namespace deflect::attack
