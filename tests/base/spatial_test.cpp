#include "msa/base/spatial.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "msa/base/stiffness_checks.h"

namespace deflect {
namespace {

TEST(Spatial, ShiftedTwistsAndWrenchesDoTheSameWork) {
  const Vector3 p(0.1, -0.2, 0.3);
  const Matrix6 X = shift_twist(p);
  Vector6 d, F;
  d << 1, 2, 3, 0.4, 0.5, 0.6;
  F << -3, 1, 2, 0.1, -0.7, 0.2;
  EXPECT_NEAR((X * d).dot(F), d.dot(X.transpose() * F), 1e-15);
  EXPECT_LE(((X * d).head<3>() - (d.head<3>() + d.tail<3>().cross(p))).norm(), 1e-16);
  EXPECT_LE((shift_twist(-p) * X - Matrix6::Identity()).norm(), 1e-16);
}

TEST(Spatial, RollPitchYawComeBack) {
  for (const double pitch : {-1.5, -0.3, 0.0, 0.9, 1.57}) {
    const Vector3 rpy(0.4, pitch, -2.0);
    const Matrix3 R = rotation_from_rpy(rpy(0), rpy(1), rpy(2));
    EXPECT_LE((rpy_from_rotation(R) - rpy).norm(), 1e-12) << pitch;
  }
  const Matrix3 upright = rotation_from_rpy(0.3, pi / 2, 0.5);  // only yaw − roll is defined here
  const Vector3 rpy = rpy_from_rotation(upright);
  EXPECT_LE((rotation_from_rpy(rpy(0), rpy(1), rpy(2)) - upright).norm(), 1e-15);
  // Rz(yaw) Ry(pitch) Rx(roll): a yaw of 90° takes x to y.
  EXPECT_LE((rotation_from_rpy(0, 0, pi / 2) * Vector3::UnitX() - Vector3::UnitY()).norm(), 1e-15);
}

TEST(Spatial, AxesAlongXAreRightHandedAndRefuseAParallelReference) {
  const Matrix3 R = axes_along_x({1, 1, 0}, {0, 1, 0});
  EXPECT_NEAR(R.determinant(), 1, 1e-15);
  EXPECT_GT(R.col(1).y(), 0);
  EXPECT_THROW(axes_along_x({0, 0, 2}, {0, 0, 1}), std::invalid_argument);
}

TEST(StiffnessChecks, ASmallestEigenvalueIsNegativeByTheToleranceAtMost) {
  const Matrix3 R = axes_along_x({1, 2, 3}, {0, 0, 1});
  for (const double share : {-1.0, 0.0, 0.5, 2.0}) {
    Matrix6 K = Matrix6::Zero();  // blocks of equal trace, so that lengths do not weigh
    K.topLeftCorner<3, 3>() = R * Vector3(-share * 0.6e-9, 0.4, 0.6).asDiagonal() * R.transpose();
    K.bottomRightCorner<3, 3>().diagonal() << 0.2, 0.3, 0.5;
    K = (K + K.transpose().eval()) / 2;
    EXPECT_EQ(check_stiffness(K, {}).positive, share < 1) << share;
    EXPECT_EQ(check_stiffness(K, {}, 1e-8).failure, "") << share;
  }
}

TEST(StiffnessChecks, FindEachFaultByName) {
  Matrix6 K = Matrix6::Zero();
  K.diagonal() << 1e5, 2e5, 3e5, 400, 500, 600;
  EXPECT_TRUE(check_stiffness(K, {}).all());
  Matrix6 asymmetric = K;
  asymmetric(0, 1) = 1;  // 1e-5 of the scale
  EXPECT_FALSE(check_stiffness(asymmetric, {}).symmetric);
  EXPECT_NE(check_stiffness(asymmetric, {}).failure.find("K = K^T"), std::string::npos);
  Matrix6 open = Matrix6::Zero();
  open(1, 0) = 1;
  EXPECT_TRUE(check_stiffness(asymmetric, {}, 1e-9, open).symmetric);
  EXPECT_FALSE(check_stiffness(asymmetric, {}, 1e-9, 0.9 * open).symmetric);
  EXPECT_FALSE(check_stiffness(-K, {}).positive);
  Matrix6 coupled = K;
  coupled(0, 4) = coupled(4, 0) = 1e5;  // > √(1e5 · 500)
  EXPECT_FALSE(check_stiffness(coupled, {}).positive);
  Matrix6X twist = Vector6::Unit(5);
  const StiffnessChecks held = check_stiffness(K, {{"leg 2", K, twist}});
  EXPECT_FALSE(held.passive_joints_free);
  EXPECT_NE(held.failure.find("leg 2 resists passive freedom 1"), std::string::npos);
  Matrix6 released = K;
  released(5, 5) = 0;
  EXPECT_TRUE(check_stiffness(K, {{"leg 2", released, twist}}).all());
  // A leg of which members 10⁹ times as stiff as its one spring leave rounding.
  EXPECT_TRUE(check_stiffness(K, {{"leg 2", 1e-14 * K, twist}}).all());
  K(3, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(check_stiffness(K, {}).all());
}

TEST(StiffnessChecks, DoNotDependOnUnits) {
  Matrix6 K = Matrix6::Zero();
  K.diagonal() << 1e5, 2e5, 3e5, 400, 500, 600;
  K(0, 3) = 1e-5 * std::sqrt(1e5 * 400);
  EXPECT_EQ(check_stiffness(K, {}).symmetric, check_stiffness(stiffness_in_mm(K), {}).symmetric);
  EXPECT_EQ(check_stiffness(K, {}).failure, check_stiffness(stiffness_in_mm(K), {}).failure);
}

TEST(ResponseChecks, FindEachFaultByName) {
  Response r;
  r.F << 10, 0, 0, 0, 0.5, 0;
  r.d << 1e-3, 0, 0, 0, 2e-3, 0;
  r.reaction = -r.F;
  r.energy = 0.5 * r.F.dot(r.d);
  EXPECT_EQ(response_failure(r), "");
  Response wrong = r;
  wrong.d = -r.d;
  EXPECT_NE(response_failure(wrong).find("sign fails"), std::string::npos);
  wrong = r;
  wrong.reaction(4) *= 1 + 1e-7;
  EXPECT_NE(response_failure(wrong).find("equilibrium fails"), std::string::npos);
  wrong = r;
  wrong.energy *= 0.9;
  EXPECT_NE(response_failure(wrong).find("energy fails"), std::string::npos);
  wrong.linear = false;  // a contact stores less than half the work
  EXPECT_EQ(response_failure(wrong), "");
  wrong.energy = r.energy * 1.1;
  EXPECT_NE(response_failure(wrong).find("energy fails"), std::string::npos);
}

// A spring k that is assembled too long by more than a brake F can hold: both rest at F, the brake has slid. A load P
// the same way lets the brake carry F still and the spring P more: E = ((F + P)² − F²)/2k, d = P/k, so that E is
// 1 + 2F/P times half the work of P.
TEST(ResponseChecks, WhereFrictionHasSlidAtRestTheEnergyHasNoBound) {
  const double k = 1e5, F = 100, P = 10;
  Response r;
  r.F << P, 0, 0, 0, 0, 0;
  r.d << P / k, 0, 0, 0, 0, 0;
  r.reaction = -r.F;
  r.energy = ((F + P) * (F + P) - F * F) / (2 * k);
  r.linear = false;
  r.strained = r.slides = true;
  EXPECT_EQ(response_failure(r), "");
  r.strained = false;
  EXPECT_NE(response_failure(r).find("energy fails"), std::string::npos);
}

// A spring in two halves that press on each other with P at rest, δ = (f/a)²ᐟ³ each: the load F takes from one what it
// gives to the other. While F grows to 2P the halves' stiffness together falls, as one of them softens to nothing.
TEST(ResponseChecks, PrestressedContactsMayStoreMoreThanHalfTheWork) {
  Response r;
  r.linear = false;
  r.d << 1, 0, 0, 0, 0, 0;
  r.F << std::pow(2, 1.5), 0, 0, 0, 0, 0;  // one half carries (1 + 1)^1.5, the other has just let go
  r.reaction = -r.F;
  r.energy = 0.4 * std::pow(2, 2.5) - 2 * 0.4;  // ∫ x^1.5 dx
  ASSERT_GT(r.energy, 0.5 * r.F.dot(r.d));
  EXPECT_NE(response_failure(r).find("energy fails"), std::string::npos);
  r.strained = true;
  EXPECT_EQ(response_failure(r), "");
  r.energy = 1.01 * r.F.dot(r.d);  // more than the load can have done
  EXPECT_NE(response_failure(r).find("energy fails"), std::string::npos);
  r.energy = -1e-3;
  EXPECT_NE(response_failure(r).find("energy fails"), std::string::npos);
  r.slides = true;  // sliding has let go what was strained
  EXPECT_EQ(response_failure(r), "");
}

}  // namespace
}  // namespace deflect
