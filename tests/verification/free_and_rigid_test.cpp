// A platform that floats in play, and one that yields in fewer than six ways: both theories say the same of both.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "msa/base/error.h"
#include "msa/frame/mechanism/msa.h"
#include "msa/mechanism/device_file.h"
#include "tests/support/devices.h"
#include "tests/support/mechanisms.h"
#include "tests/support/paths.h"
#include "validation/studies/solve.h"
#include "validation/theories/agreement.h"
#include "validation/theories/analytic_theory.h"
#include "validation/theories/msa_theory.h"

namespace deflect {
namespace {

using namespace studies;
using namespace theories;

struct Answers {
  Answer closed_form, msa;
};

Answers both_of(const Configuration& c, const Vector6& F) {
  AnalyticAt analytic(c);
  MsaAt msa(c);
  return {analytic.answer(F), msa.answer(F)};
}

Vector6 wrench(double fx, double fy, double fz, double mx, double my, double mz) {
  return (Vector6() << fx, fy, fz, mx, my, mz).finished();
}

// Three slides along the axes, each with 0.01 mm of play, and legs that hold no translation but along their slide: at
// this pose T moves with the slides, so that it floats by the gap along each axis that no force pushes.
TEST(FloatingPlay, IsTheGapOfTheDrivesThatCarryNothing) {
  const Mechanism m = read_mechanism(test::source_dir() + "/tests/attack/cases/tripteron-backlash.yaml");
  const Configuration c = stand(m, wrench(500, 500, 500, 0, 0, 0)).configuration;
  struct Case {
    Vector6 F;
    Vector3 floats;
  };
  for (const Case& k :
       {Case{wrench(0, 0, 0, 0, 0, 0), Vector3::Ones()}, Case{wrench(0, 0, 0, -10, 0, 0), Vector3::Ones()},
        Case{wrench(50, 0, 0, 0, 0, 0), Vector3(0, 1, 1)}, Case{wrench(50, 20, -30, 0, 0, 0), Vector3::Zero()}}) {
    const Answers both = both_of(c, k.F);
    EXPECT_LT(difference(both.closed_form, both.msa, c.size).largest(), 1e-9);
    for (const Answer& a : {both.closed_form, both.msa}) {
      EXPECT_EQ(a.floating.loose.size(), static_cast<std::size_t>(k.floats.sum()));
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(a.floating.most(axis), 1e-5 * k.floats(axis), 1e-14);
        EXPECT_NEAR(a.floating.least(axis), -1e-5 * k.floats(axis), 1e-14);
        const double held = k.floats(axis) > 0 ? 1e-14 : 1;  // nothing resists what floats
        EXPECT_LE(a.stiffness.row(axis).norm(), held * a.stiffness.norm());
      }
    }
  }
}

// The legs' lines times the platform's twist stay within the gap of each leg: the twist is lines⁻¹ times any lengths
// within it, and each of its components reaches the sum of the moduli of its row, times the gap.
TEST(FloatingPlay, WithoutLoadIsWithinThePlayOfAllLegs) {
  const Mechanism haptic = test::device("haptic-6psu-ideal-joints");
  const Mechanism loose = test::with(haptic, "leg.ball_joint.tz", "{law: clearance, gap: 0.02 mm}");
  const Pose pose = test::home(haptic);
  Matrix6 lines;
  for (int leg = 0; leg < 6; ++leg) {
    const SixPsuLeg at = leg_at(test::six_psu(haptic), leg + 1, pose);
    const Vector3 n = (at.p_WC - at.p_WB).normalized();
    lines.row(leg) << n.transpose(), (at.p_WC - pose.p_WT).cross(n).transpose();
  }
  const Vector6 reach = 2e-5 * lines.inverse().cwiseAbs().rowwise().sum();
  const Answers both = both_of(configure(loose, pose), Vector6::Zero());
  for (const Answer& a : {both.closed_form, both.msa}) {
    EXPECT_EQ(a.floating.loose.size(), 6u);
    EXPECT_TRUE(a.displacement.isZero(0));
    EXPECT_LE((a.floating.most - reach).norm(), 1e-10 * reach.norm());
    EXPECT_LE((a.floating.least + reach).norm(), 1e-10 * reach.norm());
  }
}

// Two motors about z, the links rigid: T moves along s = [z × (T − p); z] of each, with the compliance Σ s sᵀ/k, and
// the stiffness is infinite in four motions.
TEST(RigidDirections, AreSaidAndTheOthersAnswered) {
  const Vector3 shoulder(0.1, 0, 0), elbow(0.4, 0.3, 0), tool(0.9, 0.1, 0.05);
  for (const double ratio : {1.0, 1e-6, 1e6}) {
    const double k_1 = 2e3, k_2 = k_1 * ratio;
    const Configuration c = test::configuration(
        tool, {{"arm", {test::spring("shoulder", shoulder, {{5, k_1}}), test::spring("elbow", elbow, {{5, k_2}})}}}, 1);
    Matrix6 C = Matrix6::Zero();
    for (const auto& [p, k] : {std::pair{shoulder, k_1}, {elbow, k_2}}) {
      Vector6 s;
      s << Vector3::UnitZ().cross(tool - p), Vector3::UnitZ();
      C += s * s.transpose() / k;
    }
    const Vector6 F = wrench(30, -20, 10, 1, 2, 3), d = C * F;
    const Answers both = both_of(c, F);
    require_agreement(all_theories(), {both.closed_form, both.msa}, F, c, "here");
    EXPECT_EQ(both.closed_form.rigid_motions.size(), 4u);
    for (const Answer& a : {both.closed_form, both.msa}) {
      EXPECT_EQ(a.rigid, 4);
      EXPECT_LE((a.displacement - d).norm(), 1e-14 * d.norm());
      // On the motions that are left K is the inverse of C.
      EXPECT_LE((C * a.stiffness * C - C).norm(), 1e-14 * C.norm() * a.stiffness.norm() * C.norm());
    }
  }
}

TEST(RigidDirections, ADeviceThatNothingLetsMoveIsRefused) {
  PlacedLeg leg{"arm", {test::joint("weld", Vector3::Zero(), "rrrrrr")}};
  const Configuration c = test::configuration(Vector3(0.5, 0, 0), {leg}, 1);
  EXPECT_THROW(AnalyticAt(c).answer(wrench(1, 0, 0, 0, 0, 0)), ModelError);
}

// F against a spring with play in series: gap + F/k, in any geometry.
TEST(FiniteGeometry, ClosesAGapAndStretchesTheSpringBehindIt) {
  PlacedJoint slide = test::spring("slide", Vector3::Zero(), {{2, 1e5}});
  slide.laws[2].emplace_back(ClearanceLaw{2e-5});
  PlacedLeg leg{"leg", {slide, test::rod("rod", Vector3::Zero(), Vector3(0.2, 0, 0.1), 0.02)}};
  frame::MsaModel msa(test::configuration(Vector3(0.2, 0, 0.1), {leg}, 0.2));
  PlacedLeg without = leg;
  std::get<PlacedJoint>(without.parts[0]).laws[2].pop_back();
  frame::MsaModel tight(test::configuration(Vector3(0.2, 0, 0.1), {without}, 0.2));
  for (const Geometry geometry : {Geometry::linear, Geometry::second_order, Geometry::finite})
    for (const double f : {50.0, -50.0}) {
      const frame::MsaSolution s = msa.solve(wrench(0, 0, f, 0, 0, 0), geometry);
      const frame::MsaSolution t = tight.solve(wrench(0, 0, f, 0, 0, 0), geometry);
      ASSERT_TRUE(s.state.converged) << s.state.message;
      // The slide stays parallel to z: what stands on it moves by the gap and no other way.
      const Vector6 moved = s.displacement - t.displacement;
      EXPECT_NEAR(moved(2), std::copysign(2e-5, f), 1e-13);
      EXPECT_LT((moved - moved(2) * Vector6::Unit(2)).norm(), 1e-13);
    }
}

}  // namespace
}  // namespace deflect
