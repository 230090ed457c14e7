// Warmer than at its assembly: by hand, and both theories on the device and on over-constrained mechanisms.
#include <gtest/gtest.h>

#include "analytic/model.h"
#include "msa/frame/mechanism/msa.h"
#include "tests/support/chains.h"
#include "tests/support/devices.h"
#include "tests/support/mechanisms.h"
#include "validation/studies/solve.h"
#include "validation/theories/agreement.h"

namespace deflect {
namespace {

using namespace theories;

constexpr double alpha = 12e-6, warmer = 30, L = 0.4;  // 1/K, K, m

PlacedMember warm_rod(const std::string& name, const Vector3& a, const Vector3& b) {
  PlacedMember m = test::rod(name, a, b, 0.01);
  m.expansion = alpha;
  return m;
}

Conditions warm(Geometry geometry = Geometry::linear) {
  Conditions c(geometry);
  c.warmer = warmer;
  return c;
}

TEST(Heat, LengthensAFreeRodByAlphaDeltaTL) {
  const Configuration c =
      test::configuration(Vector3(L, 0, 0), {{"rod", {warm_rod("rod", Vector3::Zero(), Vector3(L, 0, 0))}}}, L);
  const Vector6 expected = alpha * warmer * L * Vector6::Unit(0);
  const analytic::AnalyticSolution a = analytic::AnalyticModel(c).solve(Vector6::Zero(), warm());
  EXPECT_LE((a.displacement - expected).norm(), 1e-18);
  for (const Geometry geometry : {Geometry::linear, Geometry::second_order, Geometry::finite}) {
    const frame::MsaSolution f = frame::MsaModel(c).solve(Vector6::Zero(), warm(geometry));
    EXPECT_TRUE(f.state.converged);
    EXPECT_LE((f.displacement - expected).norm(), 1e-12 * expected.norm());
  }
}

// Between walls: T in the middle of a rod that is held at both ends. It stays, and the rod is pressed with EAαΔT, whose
// strain energy is EA (αΔT)² L/2.
TEST(Heat, PressesARodBetweenWalls) {
  const Vector3 left(-L / 2, 0, 0), right(L / 2, 0, 0), T = Vector3::Zero();
  const Configuration c =
      test::configuration(T, {{"left", {warm_rod("rod", left, T)}}, {"right", {warm_rod("rod", right, T)}}}, L);
  const double EA = 210e9 * pi * 0.01 * 0.01 / 4;
  const analytic::AnalyticModel analytic(c);
  const analytic::AnalyticSolution a = analytic.solve(Vector6::Zero(), warm());
  EXPECT_LE(a.displacement.norm(), 1e-18);
  EXPECT_NEAR(a.leg_wrenches[0](0) / (-EA * alpha * warmer), 1, 1e-12);
  EXPECT_NEAR(a.leg_wrenches[1](0) / (EA * alpha * warmer), 1, 1e-12);
  EXPECT_NEAR(analytic.energies(a)[0].second / (EA * alpha * alpha * warmer * warmer * L / 2), 1, 1e-12);
  frame::MsaModel msa(c);
  const frame::MsaSolution f = msa.solve(Vector6::Zero(), warm());
  EXPECT_LE(f.displacement.norm(), 1e-16);
  EXPECT_NEAR(f.energies[0].second / (EA * alpha * alpha * warmer * warmer * L / 2), 1, 1e-12);
  EXPECT_LE(msa.base_reaction(f.load, f.state).norm(), 1e-9);  // the walls push against each other
}

double difference(const Configuration& c, const Vector6& F, const Conditions& conditions) {
  const analytic::AnalyticSolution a = analytic::AnalyticModel(c).solve(F, conditions);
  const frame::MsaSolution f = frame::MsaModel(c).solve(F, conditions);
  EXPECT_TRUE(a.converged && f.state.converged);
  return relative_difference(twist_in_mm(f.displacement), twist_in_mm(a.displacement));
}

// Where heat alone acts on a device whose legs carry nothing, contacts deflect with the power 2/3 of the rounding of
// their force: 1e-7 for them as in agreement_test.cpp, 1e-9 without.
TEST(Heat, HasOneAnswerInBothTheories) {
  std::mt19937 random(3);
  double worst = 0;
  for (const auto& [name, tolerance] : {std::pair{"haptic-6psu", 1e-7}, {"haptic-6psu-ideal-joints", 1e-9}}) {
    const Mechanism m = test::with(test::device(name), "materials.steel.expansion", "12e-6 1/K");
    for (const Pose& pose : test::random_poses(m, 20, 2)) {
      const Configuration c = configure(m, pose);
      EXPECT_LE(difference(c, test::random_wrench(random), warm()), 1e-9);
      EXPECT_LE(difference(c, Vector6::Zero(), warm()), tolerance) << name;
    }
  }
  for (unsigned seed = 1; seed < 20; ++seed) {
    Configuration c = test::random_mechanism(seed, seed % 2);
    for_each_part(c.legs, [&](auto& part) {
      if constexpr (requires { part.expansion; }) part.expansion = test::uniform(random, 0, 2e-5);
    });
    worst =
        std::max({worst, difference(c, test::random_wrench(random), warm()), difference(c, Vector6::Zero(), warm())});
  }
  EXPECT_LE(worst, 1e-9);
}

// A device whose legs' forces are those of statics is not stressed by heat: play in it stays in the middle.
TEST(Heat, LeavesPlayAloneWhereNothingIsLoaded) {
  Mechanism m = test::with(test::device("haptic-6psu-ideal-joints"), "materials.steel.expansion", "12e-6 1/K");
  const Mechanism loose = test::with(m, "leg.ball_joint.tz", "{law: clearance, gap: 0.02 mm}");
  for (const Pose& pose : test::random_poses(m, 10, 2)) {
    const Vector6 d = analytic::AnalyticModel(configure(m, pose)).solve(Vector6::Zero(), warm()).displacement;
    const Configuration c = configure(loose, pose);
    EXPECT_LE((analytic::AnalyticModel(c).solve(Vector6::Zero(), warm()).displacement - d).norm(), 1e-9 * d.norm());
    EXPECT_LE((frame::MsaModel(c).solve(Vector6::Zero(), warm()).displacement - d).norm(), 1e-9 * d.norm());
  }
}

}  // namespace
}  // namespace deflect
