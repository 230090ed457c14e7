// The relative motion of two bodies at a connection, of any size: the finite form of what Model::connect makes linear.
//
// The joint's axes R (columns) are attached to body a and turn with it: R_a = Q_a R, R_b = Q_b R. With x_a, x_b the
// places to which the bodies a and b carry the joint's point p, the six components of the motion of b against a are
//   e = R_aᵀ (x_b − x_a)                     tx, ty, tz
//   R_aᵀ R_b = Rx(α) Ry(β) Rz(γ)             rx, ry, rz: axes that turn in this order
// so that free rx and ry with rz held are a Hooke joint, x on body a and y on the cross. A rigid freedom keeps its
// component at the constraint's value, a free one does nothing, springs pull on theirs. The rotations are undefined at
// β = ±π/2, where the first and the last axis fall together.
//
// Derivatives are by [u_a; ω_a; u_b; ω_b], ω the spins of the bodies (base axes): rows exact, Hessians those by
// rotation vectors added at the state (symmetric; deformed_beam.h). With a_i the axes R_a, ρ the arm from node b to
// x_b, v from node a to x_b, and g_i reciprocal to the three axes that turn (g_i·j_k = δ_ik):
//   ė_i = a_i·(u̇_b + ω_b × ρ − u̇_a − ω_a × v),   (α̇, β̇, γ̇)_i = g_i·(ω_b − ω_a).
#pragma once

#include <array>

#include "msa/frame/elements/beam.h"
#include "msa/frame/elements/finite_rotation.h"

namespace deflect::frame {

struct JointMotion {
  Vector6 components = Vector6::Zero();
  std::array<Vector12, 6> gradient;
  std::array<Matrix12, 6> hessian;
};

/// Of the bodies of two nodes at X_a, X_b. `axes`: those of the translations and those of the rotations. `wanted`: the
/// components to evaluate, the others stay empty.
JointMotion joint_motion(const Vector3& X_a, const BodyMotion& a, const Vector3& X_b, const BodyMotion& b,
                         const Vector3& p, const std::array<Matrix3, 2>& axes, const std::array<bool, 6>& wanted);

}  // namespace deflect::frame
