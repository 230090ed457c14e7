// Members that bend far: each theory is as close to the exact answer as it says, and both are as close to each other.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/elastica.h"
#include "tests/support/mechanisms.h"
#include "validation/theories/analytic_theory.h"
#include "validation/theories/msa_theory.h"

namespace deflect {
namespace {

using namespace theories;

constexpr double length = 0.5;

/// A blade along x, 20 mm × 1 mm, thin along z.
Configuration blade(BeamTheory theory = BeamTheory::euler_bernoulli) {
  PlacedMember m = test::rod("blade", Vector3::Zero(), {length, 0, 0}, 0.01);
  m.R_WM = Matrix3::Identity();
  m.section = properties({RectangleSection{0.02, 0.001}}, 0.3);
  m.beam = theory;
  return test::configuration({length, 0, 0}, {{"leg 1", {m}}}, length);
}

double stiffness_across(const Configuration& c) {
  const auto& m = std::get<PlacedMember>(c.legs.front().parts.front());
  return m.E * m.section.Iy;
}

Answer by_msa(const Configuration& c, const Vector6& F) {
  return MsaAt(c, {"blade", frame::equal_division(c, 8)}).answer(F, Geometry::finite);
}

// The stretch of the real blade is left: N/EA is 4e-5 at P L²/EI = 10, on the way of a chain that does not stretch.
TEST(BentMembers, BothTheoriesMeetTheElastica) {
  const Configuration c = blade();
  for (const double P : {0.1, 0.5, 1.0, 2.0, 5.0, 10.0}) {
    SCOPED_TRACE(P);
    Vector6 F = Vector6::Zero();
    F(2) = P * stiffness_across(c) / (length * length);
    const test::Elastica exact = test::elastica(P, pi / 2);
    const double stretch = F(2) / (210e9 * 0.02 * 0.001);
    for (const Answer& answer : {AnalyticAt(c).answer(F, Geometry::finite), by_msa(c, F)}) {
      EXPECT_NEAR(answer.displacement(2) / length, exact.y, answer.discretisation(0) / length + stretch);
      EXPECT_NEAR(1 + answer.displacement(0) / length, exact.x, answer.discretisation(0) / length + stretch);
      EXPECT_NEAR(-answer.displacement(4), exact.angle, answer.discretisation(1) + stretch);
      EXPECT_LE(answer.discretisation(0), 1e-4 * answer.displacement.head<3>().norm());
    }
  }
}

// Bent about both axes, twisted and pulled: neither the closed form nor the MSA has an exact member here. Rotation
// vectors add up to first order only; estimates are for shapes whose difference is small. Twice for what both are
// estimates of.
TEST(BentMembers, InSpaceTheTheoriesDifferByNoMoreThanTheyLeave) {
  for (const BeamTheory theory : {BeamTheory::euler_bernoulli, BeamTheory::timoshenko})
    for (const double size : {0.01, 0.1, 0.3, 1.0}) {
      SCOPED_TRACE(size);
      const Configuration c = blade(theory);
      Vector6 F;
      F << 0.5, 1, 0.5, 0.02, 0.05, 0.2;
      const Answer a = AnalyticAt(c).answer(size * F, Geometry::finite), f = by_msa(c, size * F);
      const Eigen::Vector2d left = 2 * (a.discretisation + f.discretisation);
      EXPECT_LE((a.displacement - f.displacement).head<3>().norm(), left(0));
      EXPECT_LE((a.displacement - f.displacement).tail<3>().norm(), left(1));
      EXPECT_LE(left(0), 1e-4 * a.displacement.head<3>().norm());
    }
}

// One element and one piece where nothing bends: nothing is divided, and the estimate says so.
TEST(BentMembers, AStraightPullLeavesNothingToDivide) {
  const Configuration c = blade();
  Vector6 F = Vector6::Zero();
  F(0) = 0.1;
  EXPECT_LE(AnalyticAt(c).answer(F, Geometry::finite).discretisation(0), 1e-30);
  MsaAt msa(c, {"blade", frame::equal_division(c, 8)});
  EXPECT_LE(msa.answer(F, Geometry::finite).discretisation(0), 1e-6 * length);
  EXPECT_EQ(msa.mechanism().model.beams.size(), 8u);
}

}  // namespace
}  // namespace deflect
