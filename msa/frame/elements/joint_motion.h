// The relative motion of two bodies at a connection, of any size: the nonlinear form of the linear Model::connect.
//
// The joint's axes R (columns) are attached to body a and rotate with it: R_a = Q_a R, R_b = Q_b R. x_a and x_b are the
// displaced positions of the joint's point p as a point of body a and of body b. The motion of b relative to a has the
// six components
//   e = R_aᵀ (x_b − x_a)                     tx, ty, tz
//   R_aᵀ R_b = Rx(α) Ry(β) Rz(γ)             rx, ry, rz: axes that turn in this order
// so that free rx and ry with rz held make a Hooke joint, with x on body a and y on the cross. A rigid freedom keeps
// its component at the constraint's value, a free one is unconstrained, and springs act on theirs. The rotations are
// undefined at β = ±π/2, where the first and the last axis coincide.
//
// Derivatives are with respect to [u_a; ω_a; u_b; ω_b], with ω the spins of the bodies (base axes). Gradients are
// exact; Hessians are with respect to rotation vectors applied to the state (symmetric; deformed_beam.h). With a_i the
// axes R_a, ρ the arm from node b to x_b, v the arm from node a to x_b, and g_i reciprocal to the three rotation axes
// j_k (g_i·j_k = δ_ik):
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

/// For the bodies of two nodes at X_a, X_b. `axes`: of the translations and of the rotations. `wanted`: the components
/// to evaluate; the others are not set.
JointMotion joint_motion(const Vector3& X_a, const BodyMotion& a, const Vector3& X_b, const BodyMotion& b,
                         const Vector3& p, const std::array<Matrix3, 2>& axes, const std::array<bool, 6>& wanted);

}  // namespace deflect::frame
