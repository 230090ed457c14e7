#include "analytic/rotation_vector.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace deflect::analytic {

Matrix3 turning(const Vector3& phi) {
  const double half = phi.norm() / 2;
  const double a = half > 0 ? std::sin(half) / half : 1;  // sin θ/θ = a cos(θ/2), (1 − cos θ)/θ² = a²/2
  const Matrix3 S = skew(phi);
  return a * std::cos(half) * S + a * a / 2 * S * S;
}

Vector3 rotation_vector(const Matrix3& turning) {
  const Vector3 spin =
      Vector3(turning(2, 1) - turning(1, 2), turning(0, 2) - turning(2, 0), turning(1, 0) - turning(0, 1)) /
      2;  // sin θ times the axis
  const double sine = spin.norm();
  if (turning.trace() > -1) return sine > 0 ? Vector3(std::asin(std::min(1.0, sine)) / sine * spin) : spin;
  Eigen::Quaterniond q(Matrix3(Matrix3::Identity() + turning));
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double n = q.vec().norm();
  return 2 * std::atan2(n, q.w()) / n * q.vec();
}

RotationChange::RotationChange(const Vector3& phi) : phi_(phi) {
  const double t2 = phi.squaredNorm();
  double b;
  if (t2 < 0.04) {  // series: the closed forms lose as many digits as θ⁴ is small
    b = (1 - t2 / 12 * (1 - t2 / 30 * (1 - t2 / 56 * (1 - t2 / 90)))) / 2;
    c_ = (1 - t2 / 20 * (1 - t2 / 42 * (1 - t2 / 72 * (1 - t2 / 110)))) / 6;
    db_ = -(1 - t2 / 15 * (1 - t2 * 3 / 112 * (1 - t2 * 2 / 135))) / 12;
    dc_ = -(1 - t2 / 21 * (1 - t2 / 48 * (1 - t2 * 2 / 165))) / 60;
  } else {
    const double t = std::sqrt(t2);
    b = (1 - std::cos(t)) / t2;
    c_ = (t - std::sin(t)) / (t2 * t);
    db_ = (std::sin(t) / t - 2 * b) / t2;
    dc_ = (b - 3 * c_) / t2;
  }
  const Matrix3 S = skew(phi);
  J = Matrix3::Identity() + b * S + c_ * S * S;
}

Matrix3 RotationChange::curvature(const Vector3& m) const {
  // m · (∂J/∂φ_i e_j), made symmetric; the part b e_i × e_j has no symmetric one.
  Matrix3 A;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const Vector3 e_i = Vector3::Unit(i), e_j = Vector3::Unit(j), turned = phi_.cross(e_j);
      A(i, j) = m.dot(db_ * phi_(i) * turned + dc_ * phi_(i) * phi_.cross(turned) +
                      c_ * (e_i.cross(turned) + phi_.cross(e_i.cross(e_j))));
    }
  return (A + A.transpose()) / 2;
}

}  // namespace deflect::analytic
