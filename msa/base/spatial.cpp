#include "msa/base/spatial.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

namespace deflect {

Matrix3 rotation_from_rpy(double roll, double pitch, double yaw) {
  using Eigen::AngleAxisd;
  return (AngleAxisd(yaw, Vector3::UnitZ()) * AngleAxisd(pitch, Vector3::UnitY()) * AngleAxisd(roll, Vector3::UnitX()))
      .toRotationMatrix();
}

Vector3 rpy_from_rotation(const Matrix3& R) {
  const double cos_pitch = std::hypot(R(0, 0), R(1, 0));
  const double pitch = std::atan2(0.0 - R(2, 0), cos_pitch);  // 0.0 − x: no negative zero
  if (cos_pitch < 1e-12) return {0, pitch, std::atan2(0.0 - R(0, 1), R(1, 1))};
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

Matrix3 rotation_from_vector(const Vector3& theta) {
  const double angle = theta.norm();
  if (angle == 0) return Matrix3::Identity();
  return Eigen::AngleAxisd(angle, theta / angle).toRotationMatrix();
}

Matrix3 axes_along_x(const Vector3& x, const Vector3& reference) {
  const Vector3 ex = x.normalized();
  const Vector3 across = reference - ex * ex.dot(reference);
  if (!(across.norm() > 1e-9 * reference.norm())) throw std::invalid_argument("axis parallel to its reference");
  Matrix3 R;
  R.col(0) = ex;
  R.col(1) = across.normalized();
  R.col(2) = ex.cross(R.col(1));
  return R;
}

Matrix6 stiffness_in_mm(const Matrix6& K_SI) {
  Matrix6 K = K_SI;
  K.topLeftCorner<3, 3>() *= 1e-3;
  K.bottomRightCorner<3, 3>() *= 1e3;
  return K;
}

Matrix6 stiffness_from_mm(const Matrix6& K_mm) {
  Matrix6 K = K_mm;
  K.topLeftCorner<3, 3>() *= 1e3;
  K.bottomRightCorner<3, 3>() *= 1e-3;
  return K;
}

Vector6 twist_in_mm(const Vector6& d_SI) {
  Vector6 d = d_SI;
  d.head<3>() *= 1e3;
  return d;
}

Vector6 wrench_from_mm(const Vector6& F_mm) {
  Vector6 F = F_mm;
  F.tail<3>() *= 1e-3;
  return F;
}

Vector6 wrench_in_mm(const Vector6& F_SI) {
  Vector6 F = F_SI;
  F.tail<3>() *= 1e3;
  return F;
}

}  // namespace deflect
