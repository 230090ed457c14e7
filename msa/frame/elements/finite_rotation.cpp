#include "msa/frame/elements/finite_rotation.h"

#include <array>
#include <cmath>

namespace deflect::frame {
namespace {

/// A power series in x with its derivative.
template <std::size_t n>
std::array<double, 2> series(const std::array<double, n>& a, double x) {
  double value = 0, slope = 0;
  for (std::size_t i = n; i-- > 0;) {
    slope = slope * x + value;
    value = value * x + a[i];
  }
  return {value, slope};
}

// y/sin y and tan y/y in powers of y²; seven terms leave less than 1e-15 up to y = 1/4 and 1/8.
constexpr std::array<double, 7> y_over_sin = {
    1, 1.0 / 6, 7.0 / 360, 31.0 / 15120, 127.0 / 604800, 73.0 / 3421440, 1414477.0 / 653837184000};
constexpr std::array<double, 7> tan_over_y = {1,           1.0 / 3,         2.0 / 15,         17.0 / 315,
                                              62.0 / 2835, 1382.0 / 155925, 21844.0 / 6081075};

}  // namespace

Eigen::Quaterniond rotation_by(const Vector3& omega) {
  const double angle = omega.norm();
  if (angle == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, omega / angle));
}

Vector3 rotation_vector(const Eigen::Quaterniond& q) {
  const double sine = q.vec().norm();
  if (sine == 0) return Vector3::Zero();
  return q.vec() * (2 * std::atan2(sine, std::abs(q.w())) / std::copysign(sine, q.w()));
}

RelativeRotation::RelativeRotation(const Vector3& relative) : psi(relative) {
  const double z = psi.squaredNorm();
  if (z < 0.25) {
    const auto [k_value, k_slope] = series(y_over_sin, z / 4);
    k = k_value, dk = k_slope / 4;
    std::array<double, 6> rest{};  // (1 − k)/z, term by term
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = -y_over_sin[i + 1] / 4;
    const auto [c_value, c_slope] = series(rest, z / 4);
    c = c_value, dc = c_slope / 4;
    const auto [t_value, t_slope] = series(tan_over_y, z / 16);
    g = t_value / 8, dg = t_slope / 128;
    return;
  }
  const double h = std::sqrt(z) / 2, sine = std::sin(h), y = h / 2, tangent = std::tan(y);
  k = h / sine;
  dk = (sine - h * std::cos(h)) / (sine * sine) / (8 * h);
  c = (1 - k) / z;
  dc = (-dk - c) / z;
  g = tangent / (8 * y);
  dg = ((1 + tangent * tangent) / (8 * y) - tangent / (8 * y * y)) / (32 * y);
}

Matrix3 RelativeRotation::S() const { return k * Matrix3::Identity() + c * psi * psi.transpose(); }

Matrix3 RelativeRotation::derivative_of_S(const Vector3& mu) const {
  const double along = psi.dot(mu);
  return (2 * dk * mu + 2 * dc * along * psi) * psi.transpose() +
         c * (along * Matrix3::Identity() + psi * mu.transpose());
}

Matrix3 RelativeRotation::derivative_of_tau() const { return g * Matrix3::Identity() + 2 * dg * psi * psi.transpose(); }

}  // namespace deflect::frame
