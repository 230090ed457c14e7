// The displacements of a frame by another way than the program's, in 50 digits.
//
// Members by the force method. A member in its own axes carries at its end b the forces q = [N Vy Vz T My Mz]; all its
// sections follow from them: N, Vy, Vz, T, My − (L − x) Vz, Mz + (L − x) Vy. The works of unit loads,
//   C_ij = ∫ (N_i N_j / EA + T_i T_j / GJ + My_i My_j / EIy + Mz_i Mz_j / EIz + Vy_i Vy_j / GAy + Vz_i Vz_j / GAz) dx,
// are the flexibility of the clamped member. Releases leave those q that do not carry a released component at either
// end, q = Q s; the member's stiffness at its nodes is Bᵀ Q (Qᵀ C Q)⁻¹ Qᵀ B, where B u is the motion of end b seen from
// the body of end a, in member axes.
//
// Constraints and links by Lagrange's multipliers λ:
//   | K  Gᵀ | |u|   |f|
//   | G  0  | |λ| = |0|
// one dense matrix, factorised with full pivoting (freedoms scaled by 1/√K_ii, rows of G by their largest entry); the
// pivots of redundant constraints are zero.
#pragma once

#include <vector>

#include "msa/frame/frame_description.h"

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
