// Serial arms: one chain, whose compliance is a sum, and poses where it has no inverse.
#include <gtest/gtest.h>

#include "analytic/model.h"
#include "tests/support/mechanisms.h"

namespace deflect::analytic {
namespace {

using test::joint;
using test::rod;
using test::spring;

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const ModelError& e) {
    return e.what();
  }
  return "no refusal";
}

bool says(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

struct Arm {
  explicit Arm(unsigned seed) {
    std::mt19937 random(seed);
    Vector3 p = Vector3::Zero();
    PlacedLeg leg{"arm", {}};
    const Vector3 p_WT(0.4, 0.1, 0.3);
    for (int i = 0; i < 6; ++i) {
      const Vector3 axis = test::random_vector(random, 1).normalized();
      const double k = test::uniform(random, 1e3, 1e5);
      leg.parts.push_back(spring("motor", p, {{5, k}}, test::z_along(axis)));
      Vector6 twist;
      twist << axis.cross(p_WT - p), axis;
      C += twist * twist.transpose() / k;
      p += test::random_vector(random, 0.3);
    }
    configuration = test::configuration(p_WT, {leg}, 1);
  }
  Configuration configuration;
  Matrix6 C = Matrix6::Zero();  // Σ J_i J_iᵀ/k_i
};

TEST(SerialArm, ComplianceIsTheSumOverItsMotors) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Arm arm(seed);
    const AnalyticModel model(arm.configuration);
    const Vector6 F = (Vector6() << 50, -20, 30, 1, 2, -3).finished();
    const AnalyticSolution s = model.solve(F);
    ASSERT_TRUE(s.converged);
    EXPECT_LE((s.displacement - arm.C * F).norm(), 1e-12 * (arm.C * F).norm());
    EXPECT_LE((model.compliance(s) - arm.C).norm(), 1e-12 * arm.C.norm());
    // K C = 1 to the digits that the conditions of C leave.
    const Vector6 eigen = Eigen::SelfAdjointEigenSolver<Matrix6>(arm.C).eigenvalues();
    EXPECT_LE((model.stiffness(s) * arm.C - Matrix6::Identity()).norm(), 1e-13 * eigen(5) / eigen(0));
  }
}

// Two links stretched along x that turn about z: the tip moves along y and turns about z, nothing else yields; with six
// motors of which two turn about one line the tip loses one direction.
TEST(SerialArm, ASingularPoseNamesTheLostDirection) {
  PlacedLeg arm{"arm", {}};
  const auto motor = [&](const Vector3& p, const Vector3& axis) {
    arm.parts.push_back(spring("motor", p, {{5, 1e4}}, test::z_along(axis)));
  };
  // Shoulder with three axes, stretched elbow, wrist of two axes: the hand cannot be pulled away from the shoulder.
  motor(Vector3::Zero(), Vector3::UnitZ());
  motor(Vector3::Zero(), Vector3::UnitY());
  motor(Vector3(0.3, 0, 0), Vector3::UnitY());
  motor(Vector3(0.6, 0, 0), Vector3::UnitX());
  motor(Vector3(0.6, 0, 0), Vector3::UnitY());
  motor(Vector3(0.6, 0, 0), Vector3::UnitZ());
  const AnalyticModel model(test::configuration(Vector3(0.6, 0, 0), {arm}, 1));
  const AnalyticSolution s = model.solve(Vector6::Unit(1));
  ASSERT_TRUE(s.converged);
  EXPECT_NEAR(s.displacement(1), 0.36e-4, 1e-16);
  EXPECT_EQ(model.compliance(s).row(0).norm(), 0);
  const std::string text = refusal([&] { model.stiffness(s); });
  EXPECT_TRUE(says(text, "infinite stiffness: held rigidly, nothing yields in translation along (1, 0, 0);")) << text;
  // Pulled along the arm nothing moves.
  EXPECT_LE(model.solve(Vector6::Unit(0)).displacement.norm(), 1e-16);
}

TEST(SerialArm, EveryDirectionInWhichNothingYieldsIsNamed) {
  const PlacedLeg arm{"arm",
                      {spring("motor", Vector3::Zero(), {{5, 1e4}}), spring("slide", Vector3::Zero(), {{2, 1e5}})}};
  const AnalyticModel model(test::configuration(Vector3(0.5, 0, 0), {arm}, 0.5));
  const std::string text = refusal([&] { model.stiffness(model.solve(Vector6::Unit(2))); });
  for (const char* motion : {"translation along (1, 0, 0)", "rotation about (1, 0, 0)", "rotation about (0, 1, 0)",
                             "translation along (0, 1, 0) of T + (-500, 0, 0) mm"})
    EXPECT_TRUE(says(text, motion)) << text;
  EXPECT_FALSE(says(text, "(0, 0, 1)")) << text;
}

TEST(SerialArm, APassiveJointLeavesItWithoutStand) {
  const PlacedLeg arm{
      "arm", {joint("hinge", Vector3::Zero(), "rrrrrf"), rod("link", Vector3::Zero(), Vector3::UnitX(), 0.02)}};
  const AnalyticModel model(test::configuration(Vector3::UnitX(), {arm}, 1));
  const std::string text = refusal([&] { model.solve(Vector6::Unit(0)); });
  EXPECT_TRUE(says(text, "cannot stand")) << text;
  EXPECT_TRUE(says(text, "rotation about (0, 0, 1) through T + (-1000, 0, 0) mm")) << text;
}

TEST(SerialArm, SixCoupledSpringsOfAJointMoveToTheToolPoint) {
  std::mt19937 random(4);
  Matrix6 A;
  for (int i = 0; i < 36; ++i) A(i) = test::uniform(random, -1, 1);
  PlacedJoint flexure = joint("flexure", Vector3(0.1, 0.2, 0), "rrrrrr", test::z_along(Vector3(1, 2, 3)));
  flexure.stiffness = 1e4 * (A * A.transpose() + Matrix6::Identity());
  const Vector3 p_WT(0.3, 0.1, -0.2);
  const AnalyticModel model(test::configuration(p_WT, {{"leg", {flexure}}}, 0.4));
  const Matrix6 X = shift_twist(p_WT - flexure.p_W) * rotate_twist(flexure.R_WJ);
  const Matrix6 C = X * flexure.stiffness->inverse() * X.transpose();
  EXPECT_LE((model.compliance(model.solve(Vector6::Unit(0))) - C).norm(), 1e-12 * C.norm());
}

// A Hertz contact without load has no stiffness: the force that makes it exists only under load.
TEST(SerialArm, AnUnloadedContactLetsGo) {
  PlacedJoint contact = spring("contact", Vector3::Zero(), {{0, 1e6}, {1, 1e6}, {3, 1e3}, {4, 1e3}, {5, 1e3}});
  contact.laws[2].push_back(HertzPointLaw{"", 0.004, {210e9, 0.3, {}}});
  const AnalyticModel model(test::configuration(Vector3::Zero(), {{"leg", {contact}}}, 0.1));
  const AnalyticSolution rest = model.solve(Vector6::Zero());
  EXPECT_TRUE(rest.converged);
  EXPECT_LE(model.stiffness(rest).row(2).norm(), 0);
  const std::string text = refusal([&] { model.compliance(rest); });
  EXPECT_TRUE(says(text, "translation along (0, 0, 1)")) << text;
  EXPECT_GT(model.stiffness(model.solve(Vector6::Unit(2)))(2, 2), 1e5);
}

}  // namespace
}  // namespace deflect::analytic
