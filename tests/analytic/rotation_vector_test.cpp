// Rotation vectors and how they change, against power series and differences.
#include "analytic/rotation_vector.h"

#include <gtest/gtest.h>

namespace deflect::analytic {
namespace {

// J = Σ [φ]×ⁿ/(n + 1)!, by small angles and large ones; 30 terms of it are exact where |φ| < 3.
TEST(RotationChange, IsTheSeriesOfTheRotationVector) {
  const Vector3 axis = Vector3(1, -2, 0.5).normalized();
  for (const double angle : {1e-9, 1e-3, 0.05, 0.15, 0.1999, 0.2001, 0.7, 2.9}) {
    const Matrix3 S = skew(angle * axis);
    Matrix3 term = Matrix3::Identity(), series = term;
    for (int n = 1; n < 30; ++n) {
      term = term * S / (n + 1);
      series += term;
    }
    EXPECT_LE((RotationChange(angle * axis).J - series).norm(), 1e-14) << angle;
  }
}

// exp([φ + d]×) = exp([ψ]×) exp([φ]×), ψ = J d + ½ Q(d, d): half the difference of both senses is J d, half the sum
// ½ Q, but for d³ and d⁴ and rounding.
TEST(RotationChange, IsTheChangeToTheSecondOrder) {
  const Vector3 axis = Vector3(0.3, 1, -0.6).normalized(), step(0.5, -0.2, 0.8), m(0.4, -1, 0.7);
  constexpr double h = 1e-3;
  for (const double angle : {0.0, 0.1, 0.19, 0.21, 1.3}) {
    const Vector3 phi = angle * axis;
    const auto change = [&](double size) {
      return rotation_vector(combined(turning(phi + size * step), turning(-phi)));
    };
    const RotationChange by(phi);
    EXPECT_LE(((change(h) - change(-h)) / (2 * h) - by.J * step).norm(), h * h) << angle;
    EXPECT_NEAR(m.dot(change(h) + change(-h)) / (h * h), step.dot(by.curvature(m) * step), 1e-15 / (h * h) + h * h)
        << angle;
  }
}

}  // namespace
}  // namespace deflect::analytic
