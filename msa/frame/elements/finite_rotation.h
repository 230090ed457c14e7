// Rotations of any size: unit quaternions for states, vectors (axis times angle) for increments and differences.
#pragma once

#include <Eigen/Geometry>

#include "msa/base/spatial.h"

namespace deflect::frame {

/// How the body of a node has moved from the undeformed shape: its node by u (m), its axes by Q, both in base axes.
struct BodyMotion {
  Vector3 u = Vector3::Zero();
  Eigen::Quaterniond Q = Eigen::Quaterniond::Identity();
};

/// The rotation by the vector ω (rad), and its inverse: the vector of the shortest rotation that q is, |ω| ≤ π.
Eigen::Quaterniond rotation_by(const Vector3& omega);
Vector3 rotation_vector(const Eigen::Quaterniond& q);

/// Q v − v, to the digits of the rotation rather than of v.
inline Vector3 turned_away(const Eigen::Quaterniond& Q, const Vector3& v) {
  const Vector3 across = 2 * Q.vec().cross(v);
  return Q.w() * across + Q.vec().cross(across);
}

/// What a rotation vector ψ = log(AᵀB), θ = |ψ|, is between two sets of axes and their mean M = A exp([ψ/2]×). All
/// vectors in the axes M, in which ψ has the same components as in A and in B. The axes turn by the spins ω_a, ω_b,
/// δ = ω_b − ω_a:
///   dψ = S δ,  S = k I + c ψψᵀ,  k = (θ/2)/sin(θ/2),  c = (1 − k)/θ²
///   ω_M = ½(ω_a + ω_b) + δ × τ,  τ = g ψ,  g = tan(θ/4)/2θ
/// (the left Jacobian of ψ taken half-way: S = J⁻¹(ψ) exp([ψ/2]×) is symmetric; M is the normalised sum of the two
/// quaternions). Holds for θ < 2π; J as in M. A. Crisfield, Non-linear Finite Element Analysis II, 1997, eq. (16.94).
struct RelativeRotation {
  explicit RelativeRotation(const Vector3& psi);

  Matrix3 S() const;
  Vector3 tau() const { return g * psi; }
  /// d(S μ)/dψ for a constant μ, and dτ/dψ.
  Matrix3 derivative_of_S(const Vector3& mu) const;
  Matrix3 derivative_of_tau() const;

  Vector3 psi;
  double k, c, g, dk, dc, dg;  ///< and their derivatives by θ²
};

}  // namespace deflect::frame
