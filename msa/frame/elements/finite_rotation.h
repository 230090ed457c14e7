// Rotations of any size: unit quaternions for states, vectors (axis times angle) for increments and differences.
#pragma once

#include <Eigen/Geometry>

#include "msa/base/spatial.h"

namespace deflect::frame {

/// Motion of a node's body from the undeformed shape: translation u of the node (m) and rotation Q, both in base axes.
struct BodyMotion {
  Vector3 u = Vector3::Zero();
  Eigen::Quaterniond Q = Eigen::Quaterniond::Identity();
};

/// The rotation by the vector ω (rad), and the inverse: the rotation vector of q with |ω| ≤ π.
Eigen::Quaterniond rotation_by(const Vector3& omega);
Vector3 rotation_vector(const Eigen::Quaterniond& q);

/// Q v − v, accurate relative to the rotation rather than to v.
inline Vector3 turned_away(const Eigen::Quaterniond& Q, const Vector3& v) {
  const Vector3 across = 2 * Q.vec().cross(v);
  return Q.w() * across + Q.vec().cross(across);
}

/// The rotation vector ψ = log(AᵀB), θ = |ψ|, between two sets of axes, their mean M = A exp([ψ/2]×), and the
/// derivatives. All vectors are in the axes M, in which ψ has the same components as in A and in B. For spins ω_a, ω_b
/// of the axes and δ = ω_b − ω_a:
///   dψ = S δ,  S = k I + c ψψᵀ,  k = (θ/2)/sin(θ/2),  c = (1 − k)/θ²
///   ω_M = ½(ω_a + ω_b) + δ × τ,  τ = g ψ,  g = tan(θ/4)/2θ
/// (the left Jacobian of ψ at half the rotation: S = J⁻¹(ψ) exp([ψ/2]×) is symmetric; M is the normalised sum of the
/// two quaternions). Holds for θ < 2π; J as in M. A. Crisfield, Non-linear Finite Element Analysis II, 1997, eq.
/// (16.94).
struct RelativeRotation {
  explicit RelativeRotation(const Vector3& psi);

  Matrix3 S() const;
  Vector3 tau() const { return g * psi; }
  /// d(S μ)/dψ for a constant μ, and dτ/dψ.
  Matrix3 derivative_of_S(const Vector3& mu) const;
  Matrix3 derivative_of_tau() const;

  Vector3 psi;
  double k, c, g, dk, dc, dg;  ///< coefficients, and their derivatives with respect to θ²
};

}  // namespace deflect::frame
