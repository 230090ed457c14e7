// Spatial algebra in monogram notation.
//
// A displacement (small twist) of frame T in axes W is d_T_W = [δ; θ] (m, rad); a wrench is F_T_W = [f; m] (N, Nm):
// translation first. Virtual work is dᵀF. All vectors are in one set of axes unless a name says otherwise.
#pragma once

#include <numbers>

#include "msa/base/decompositions.h"

namespace deflect {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix6X = Eigen::Matrix<double, 6, Eigen::Dynamic>;
using VectorX = Eigen::VectorXd;
using MatrixX = Eigen::MatrixXd;

inline constexpr double pi = std::numbers::pi;

/// max |v_i|, 0 where there are none.
inline double largest(const VectorX& v) { return v.size() ? v.cwiseAbs().maxCoeff() : 0; }

/// [p]×, so that skew(p) y = p × y.
inline Matrix3 skew(const Vector3& p) {
  Matrix3 s;
  s << 0, -p.z(), p.y(), p.z(), 0, -p.x(), -p.y(), p.x(), 0;
  return s;
}

/// X with d_P = X d_Q for two points of one rigid body, p_QP = P − Q: δ_P = δ_Q + θ × p_QP.
/// Wrenches go the other way, F_Q = Xᵀ F_P, and a compliance moves from Q to P as C_P = X C_Q Xᵀ.
inline Matrix6 shift_twist(const Vector3& p_QP) {
  Matrix6 X = Matrix6::Identity();
  X.topRightCorner<3, 3>() = -skew(p_QP);
  return X;
}

/// diag(R, R): transforms a twist or a wrench to other axes, at the same point.
inline Matrix6 rotate_twist(const Matrix3& R) {
  Matrix6 X = Matrix6::Zero();
  X.topLeftCorner<3, 3>() = R;
  X.bottomRightCorner<3, 3>() = R;
  return X;
}

/// A pose of the tool frame T in the base frame W.
struct Pose {
  Vector3 p_WT = Vector3::Zero();
  Matrix3 R_WT = Matrix3::Identity();
};

/// R = Rz(yaw) Ry(pitch) Rx(roll), angles in rad.
Matrix3 rotation_from_rpy(double roll, double pitch, double yaw);

/// (roll, pitch, yaw) in rad with pitch in [−π/2, π/2]; at |pitch| = π/2, where only yaw ∓ roll is defined, roll = 0.
Vector3 rpy_from_rotation(const Matrix3& R);

/// Rotation by the vector θ (axis times angle, rad): exp([θ]×).
Matrix3 rotation_from_vector(const Vector3& theta);

/// Right-handed axes with the given first axis; the second lies in the plane of the first and `reference`, on the
/// reference's side. Throws std::invalid_argument when they are parallel to 1e-9.
Matrix3 axes_along_x(const Vector3& x, const Vector3& reference);

/// A 6×6 stiffness from SI to the units of results: N/mm, N (N/rad), Nmm (Nmm/rad).
Matrix6 stiffness_in_mm(const Matrix6& K_SI);
Matrix6 stiffness_from_mm(const Matrix6& K_mm);

/// [m, rad] → [mm, rad] and its inverse; [N, Nm] → [N, Nmm] and its inverse.
Vector6 twist_in_mm(const Vector6& d_SI);
Vector6 wrench_from_mm(const Vector6& F_mm);
Vector6 wrench_in_mm(const Vector6& F_SI);

}  // namespace deflect
