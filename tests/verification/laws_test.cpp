// Laws of joints that are not linear, by both theories: on the haptic device wherever a leg may yield, over decades of
// their parameters, in an over-constrained mechanism, and at the limits where the device is the one without them.
#include <gtest/gtest.h>

#include "analytic/constraint.h"
#include "analytic/model.h"
#include "msa/frame/mechanism/msa.h"
#include "msa/mechanism/device_file.h"
#include "tests/support/chains.h"
#include "tests/support/devices.h"
#include "tests/support/mechanisms.h"
#include "validation/studies/solve.h"
#include "validation/theories/agreement.h"
#include "validation/theories/analytic_theory.h"
#include "validation/theories/msa_theory.h"

namespace deflect {
namespace {

using namespace theories;

const Mechanism& haptic() {
  static const Mechanism m = test::device("haptic-6psu-ideal-joints");
  return m;
}

/// Both theories on one configuration, which must have one answer.
struct Both {
  analytic::AnalyticSolution a;
  frame::MsaSolution f;
  double displacement = 0, stiffness = 0, energy = 0;  ///< relative differences
};

double total(const std::vector<std::pair<std::string, double>>& energies) {
  double sum = 0;
  for (const auto& [part, energy] : energies) sum += energy;
  return sum;
}

Both both(const Configuration& c, const Vector6& F, const Conditions& conditions = {}) {
  const analytic::AnalyticModel analytic(c);
  frame::MsaModel msa(c);
  Both b{analytic.solve(F, conditions), msa.solve(F, conditions)};
  b.displacement = relative_difference(twist_in_mm(b.f.displacement), twist_in_mm(b.a.displacement));
  if (!b.a.converged || !b.f.state.converged) return b;
  b.stiffness = test::stiffness_difference(msa.stiffness(b.f.state).K, analytic.stiffness(b.a), c.size);
  const double stored = total(analytic.energies(b.a));
  b.energy = std::abs(total(b.f.energies) - stored) / std::abs(stored);
  return b;
}

// In a device whose forces are those of statics, a law changes no force, and both theories know the deflection of a law
// at a force to rounding: 1e-9 is what stiffnesses that differ by many decades leave of it. A clearance that the MSA
// closes by a contact stiffness is closed to rounding too (stepped_spring.h).
class EveryLaw : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(EveryLaw, HasOneAnswerInBothTheories) {
  const auto& [site, law] = GetParam();
  const Mechanism m = test::with(haptic(), site, law);
  std::mt19937 random(5);
  double displacement = 0, stiffness = 0, energy = 0;
  for (const Pose& pose : test::random_poses(m, 50, 4)) {
    const Both b = both(configure(m, pose), test::random_wrench(random));
    ASSERT_TRUE(b.a.converged) << b.a.message;
    ASSERT_TRUE(b.f.state.converged) << b.f.state.iterations << " " << b.f.state.residual;
    displacement = std::max(displacement, b.displacement);
    stiffness = std::max(stiffness, b.stiffness);
    energy = std::max(energy, b.energy);
  }
  EXPECT_LE(displacement, 1e-9);
  EXPECT_LE(stiffness, 1e-9);
  EXPECT_LE(energy, 1e-9);
}

std::vector<std::pair<const char*, const char*>> laws_by_site() {
  const char* sites[] = {"leg.ball_joint.tz", "leg.actuator.tz", "leg.mount.tz"};
  const char* along[] = {
      "{law: power, deflection: 2.5 um, force: 1 N, exponent: 0.6667}",
      "{law: power, deflection: 0.1 mm, force: 100 N, exponent: 0.1}",
      "{law: power, deflection: 1 um, force: 1 N, exponent: 0.9}",
      "{law: power, deflection: 1 um, force: 1 N, exponent: 1}",
      "{law: power, deflection: 1e-3 um, force: 1 N, exponent: 0.5}",
      "{law: one_sided, pull: 0.001 mm/N}",
      "{law: one_sided, push: 0.1 mm/N}",
      "{law: one_sided, pull: 1e-5 mm/N, push: 0.01 mm/N}",
      "{law: one_sided, pull: 1e-9 mm/N, push: 0 mm/N}",
      "{law: hardening, stiffness: 500 N/mm, reference: 0.1 mm}",
      "{law: hardening, stiffness: 500 N/mm, reference: 1 um}",
      "{law: hardening, stiffness: 1e6 N/mm, reference: 10 mm}",
      "{law: clearance, gap: 0.02 mm}",
      "{law: clearance, gap: 1 mm}",
      "{law: clearance, gap: 1e-6 mm}",
      "{law: friction, force: 1000 N, stiffness: 1e4 N/mm}",
      "[{law: clearance, gap: 0.02 mm}, {law: linear, stiffness: 1000 N/mm}]",
      "[{law: clearance, gap: 0.02 mm}, {law: power, deflection: 2.5 um, force: 1 N, exponent: 0.6}, "
      "{law: one_sided, pull: 0.001 mm/N}]",
      "[{law: friction, force: 1000 N, stiffness: 1e4 N/mm}, {law: clearance, gap: 0.1 mm}]"};
  std::vector<std::pair<const char*, const char*>> all;
  for (const char* site : sites)
    for (const char* law : along) all.emplace_back(site, law);
  for (const char* law : {"{law: power, deflection: 1 mrad, moment: 1 Nm, exponent: 0.7}",
                          "{law: one_sided, pull: 0.01 rad/Nm, push: 0.001 rad/Nm}",
                          "{law: hardening, stiffness: 100 Nm/rad, reference: 0.01 rad}",
                          "{law: clearance, gap: 0.1 deg}", "{law: friction, moment: 100 Nm, stiffness: 1e4 Nm/rad}"})
    all.emplace_back("leg.actuator.ry", law);
  all.emplace_back("tool.tx", "{law: clearance, gap: 0.1 mm}");
  all.emplace_back("base.rz", "{law: one_sided, pull: 0.01 rad/Nm}");
  all.emplace_back("leg.actuator.tz", "{law: cable, EA: 1000 N}");
  return all;
}

INSTANTIATE_TEST_SUITE_P(Sites, EveryLaw, ::testing::ValuesIn(laws_by_site()));

// What the shape changes, up to what the MSA's single element in each member leaves of it.
class JumpInDeformedShape : public ::testing::TestWithParam<const char*> {};

TEST_P(JumpInDeformedShape, IsThatOfTheMsa) {
  const Mechanism m = test::with(haptic(), "leg.actuator.tz", GetParam());
  std::mt19937 random(7);
  for (const Pose& pose : test::random_poses(m, 5, 9)) {
    const Vector6 F = test::random_wrench(random);
    const Both bent = both(configure(m, pose), F, Geometry::finite), straight = both(configure(m, pose), F);
    ASSERT_TRUE(bent.a.converged && bent.f.state.converged) << bent.a.message;
    const Vector6 change = straight.f.displacement - bent.f.displacement;
    EXPECT_LE((bent.a.displacement - bent.f.displacement).head<3>().norm(), 0.01 * change.head<3>().norm());
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, JumpInDeformedShape,
                         ::testing::Values("{law: one_sided, pull: 0.0001 mm/N}", "{law: clearance, gap: 0.01 mm}",
                                           "{law: one_sided, pull: 1e-4 mm/N, push: 2e-4 mm/N}"));

const char* beside(double force_N, double stiffness_N_per_mm) {
  static std::string text;
  text = fmt::format(
      "{{friction: {{joint: custom, freedoms: ffrfff, at: C, axes: link, tz: {{law: friction, force: {} N, stiffness: "
      "{} N/mm}}}}}}",
      force_N, stiffness_N_per_mm);
  return text.c_str();
}

Mechanism with_friction(double force_N, double stiffness_N_per_mm) {
  return test::with(haptic(), "beside", beside(force_N, stiffness_N_per_mm), Edit::Action::append);
}

// Beside the legs, friction makes the device over-constrained; what slips and what sticks is for each theory to find.
TEST(FrictionBesideLegs, HasOneAnswerAlongASequenceOfLoads) {
  std::mt19937 random(6);
  double displacement = 0, stiffness = 0, slip = 0;
  int slid = 0, stuck = 0;
  for (const double force : {0.01, 0.3, 2.0, 10.0, 1e3})
    for (const double k : {1.0, 1e2, 1e4, 1e7}) {
      const Mechanism m = with_friction(force, k);
      for (const Pose& pose : test::random_poses(m, 3, 8)) {
        const Configuration c = configure(m, pose);
        EXPECT_EQ(c.legs.size(), 12u);
        Conditions conditions;
        for (int load = 0; load < 4; ++load) {
          const Both b = both(c, test::random_wrench(random) * (load == 3 ? 0.2 : 1), conditions);
          ASSERT_TRUE(b.a.converged) << b.a.message << " " << force << " " << k;
          ASSERT_TRUE(b.f.state.converged) << b.f.state.iterations << " " << b.f.state.residual;
          displacement = std::max(displacement, b.displacement);
          stiffness = std::max(stiffness, b.stiffness);
          ASSERT_EQ(b.a.slips.size(), 6u);
          for (std::size_t i = 0; i < 6; ++i) {
            slip = std::max(slip, std::abs(b.a.slips[i] - b.f.slips[i]) / b.a.displacement.head<3>().norm());
            const bool moved = conditions.slips.empty() ? b.a.slips[i] != 0 : b.a.slips[i] != conditions.slips[i];
            ++(moved ? slid : stuck);
          }
          conditions.slips = b.a.slips;
        }
      }
    }
  EXPECT_LE(displacement, 1e-9);
  EXPECT_LE(stiffness, 1e-9);
  EXPECT_LE(slip, 1e-9);
  EXPECT_GT(slid, 100);
  EXPECT_GT(stuck, 100);
}

// Four legs of rods between joints that yield: laws that jump in several joints of an over-constrained mechanism.
TEST(OverConstrained, HasOneAnswerWithLawsThatJump) {
  double displacement = 0, stiffness = 0;
  int opened = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    Configuration c = test::random_mechanism(seed);
    for_each_part(c.legs, [&](auto& part) {
      if constexpr (requires { part.laws; })
        for (std::size_t i = 0; i < 6; ++i)
          if (!part.laws[i].empty() && random() % 2) {
            const double unit = i < 3 ? 1e-5 : 1e-4;
            const Law laws[] = {ClearanceLaw{unit * test::uniform(random, 0.1, 3)},
                                OneSidedLaw{unit * test::uniform(random, 0, 0.1), {}},
                                PowerLaw{unit, i < 3 ? 10. : 1., test::uniform(random, 0.4, 1)},
                                HardeningLaw{i < 3 ? 1e5 : 1e2, unit},
                                OneSidedLaw{{}, unit * test::uniform(random, 0, 0.1)}};
            part.laws[i].push_back(laws[random() % 5]);
          }
    });
    for (int load = 0; load < 3; ++load) {
      const Both b = both(c, test::random_wrench(random));
      ASSERT_TRUE(b.a.converged) << seed << ": " << b.a.message << b.a.iterations << " " << b.a.misfit;
      ASSERT_TRUE(b.f.state.converged) << seed << ": " << b.f.state.iterations << " " << b.f.state.residual;
      displacement = std::max(displacement, b.displacement);
      stiffness = std::max(stiffness, b.stiffness);
      for (const analytic::Step& step : b.a.under.steps) opened += step.released;
    }
  }
  EXPECT_LE(displacement, 1e-9);
  EXPECT_LE(stiffness, 1e-9);
  EXPECT_GT(opened, 5) << "too few clearances end between their sides";
}

// Contacts, clearances, friction and stops beside the legs of one device, a sequence of loads, parameters over decades.
TEST(AllTogether, HasOneAnswerInBothTheories) {
  std::mt19937 random(1);
  const auto decades = [&](double low, double high) { return std::pow(10, test::uniform(random, low, high)); };
  const Mechanism contacts = test::device("haptic-6psu");
  double worst = 0;
  for (unsigned i = 0; i < 70; ++i) {
    const double force = decades(-2, 2), k = decades(2, 6), gap = decades(-4, 0);
    Mechanism m = contacts;
    if (i % 2) m = test::with(m, "beside", beside(force, k), Edit::Action::append);
    if (i % 3)
      m = test::with(m, "leg.ball_joint.tz", fmt::format("{{law: clearance, gap: {} mm}}", gap), Edit::Action::append);
    if (i % 5 == 0) m = test::with(m, "leg.mount.tz", "{law: one_sided, pull: 0.001 mm/N}");
    if (i % 7 == 0)
      m = test::with(m, "beside",
                     fmt::format("{{stop: {{joint: custom, freedoms: ffrfff, at: C, axes: link, tz: [{{law: clearance, "
                                 "gap: {} mm}}, {{law: linear, stiffness: {} N/mm}}]}}}}",
                                 gap / 3, k),
                     Edit::Action::append);
    const Configuration c = configure(m, test::random_poses(m, 1, i + 1).front());
    const analytic::AnalyticModel analytic(c);
    frame::MsaModel msa(c);
    Conditions conditions;
    for (int load = 0; load < 4; ++load) {
      const Vector6 F = test::random_wrench(random);
      const analytic::AnalyticSolution a = analytic.solve(F, conditions);
      const frame::MsaSolution f = msa.solve(F, conditions);
      ASSERT_TRUE(a.converged) << i << ": " << a.message << " " << a.misfit;
      ASSERT_TRUE(f.state.converged) << i << ": " << f.state.iterations << " " << f.state.residual;
      worst = std::max(worst, relative_difference(twist_in_mm(f.displacement), twist_in_mm(a.displacement)));
      conditions.slips = a.slips;
    }
  }
  EXPECT_LE(worst, 1e-9);
}

/// Displacement by the closed form; the tests above hold the MSA to it.
Vector6 moved(const Mechanism& m, const Pose& pose, const Vector6& F) {
  const analytic::AnalyticSolution s = analytic::AnalyticModel(configure(m, pose)).solve(F);
  EXPECT_TRUE(s.converged) << s.message;
  return s.displacement;
}

double difference(const Vector6& a, const Vector6& b) { return relative_difference(twist_in_mm(a), twist_in_mm(b)); }

// What a law adds vanishes in proportion to its smallness; the bounds are that proportion.
TEST(Limits, AreTheDeviceWithoutTheLaw) {
  std::mt19937 random(7);
  for (const Pose& pose : test::random_poses(haptic(), 5, 3)) {
    const Vector6 F = test::random_wrench(random), d = moved(haptic(), pose, F);
    const auto from = [&](const char* law) {
      return difference(moved(test::with(haptic(), "leg.mount.tz", law), pose, F), d);
    };
    EXPECT_LE(from("{law: clearance, gap: 0 mm}"), 1e-12);
    EXPECT_LE(from("{law: clearance, gap: 1e-9 mm}"), 1e-6);
    EXPECT_GE(from("{law: clearance, gap: 1e-3 mm}"), 1e-4);
    EXPECT_LE(from("{law: one_sided, pull: 0 mm/N, push: 0 mm/N}"), 1e-12);
    EXPECT_LE(from("{law: friction, force: 1e9 N, stiffness: 1e12 N/mm}"), 1e-6);
    EXPECT_LE(difference(moved(with_friction(1e-12, 1e4), pose, F), d), 1e-9);
    EXPECT_LE(difference(moved(with_friction(1e6, 1e-3), pose, F), d), 1e-4);
    const Mechanism steel = test::with(haptic(), "materials.steel.expansion", "12e-6 1/K");
    EXPECT_EQ(moved(steel, pose, F), d);
    const Mechanism linear = test::with(haptic(), "leg.mount.tz", "{law: linear, stiffness: 500 N/mm}"),
                    hard =
                        test::with(haptic(), "leg.mount.tz", "{law: hardening, stiffness: 500 N/mm, reference: 1 m}"),
                    power = test::with(haptic(), "leg.mount.tz",
                                       "{law: power, deflection: 0.002 mm, force: 1 N, exponent: 1}"),
                    both_sides =
                        test::with(haptic(), "leg.mount.tz", "{law: one_sided, pull: 0.002 mm/N, push: 0.002 mm/N}");
    for (const Mechanism& same : {hard, power, both_sides})
      EXPECT_LE(difference(moved(same, pose, F), moved(linear, pose, F)), 1e-6);
  }
}

// Every leg lengthens by gap · sign(f): as if its links were that much longer or shorter.
TEST(Clearance, MovesThePlatformAsTheLegsThatItLengthens) {
  std::mt19937 random(9);
  const Mechanism loose = test::with(haptic(), "leg.ball_joint.tz", "{law: clearance, gap: 0.02 mm}");
  for (const Pose& pose : test::random_poses(haptic(), 5, 3)) {
    const Vector6 F = test::random_wrench(random);
    const Configuration c = configure(haptic(), pose);
    const analytic::AnalyticSolution rigid = analytic::AnalyticModel(c).solve(F);
    Matrix6 lines;  // of the legs: rows [n; (C − T) × n]
    Vector6 longer;
    for (int leg = 0; leg < 6; ++leg) {
      const SixPsuLeg at = leg_at(test::six_psu(haptic()), leg + 1, pose);
      const Vector3 n = (at.p_WC - at.p_WB).normalized();
      lines.row(leg) << n.transpose(), (at.p_WC - pose.p_WT).cross(n).transpose();
      longer(leg) = std::copysign(2e-5, n.dot(rigid.leg_wrenches[static_cast<std::size_t>(leg)].head<3>()));
    }
    const Vector6 expected = rigid.displacement + lines.partialPivLu().solve(longer);
    EXPECT_LE(difference(moved(loose, pose, F), expected), 1e-10);
  }
}

TEST(WithoutLoad, NothingMovesAndNothingFails) {
  for (const char* law : {"{law: clearance, gap: 0.02 mm}", "{law: one_sided, pull: 0.1 mm/N}",
                          "{law: power, deflection: 1 um, force: 1 N, exponent: 0.3}"})
    for (const char* site : {"leg.ball_joint.tz", "leg.actuator.tz", "tool.tx"}) {
      const Configuration c = configure(test::with(haptic(), site, law), test::home(haptic()));
      EXPECT_TRUE(analytic::AnalyticModel(c).solve(Vector6::Zero()).displacement.isZero(0));
      for (const Geometry geometry : {Geometry::linear, Geometry::second_order, Geometry::finite})
        EXPECT_TRUE(frame::MsaModel(c).solve(Vector6::Zero(), geometry).displacement.isZero(0)) << law << site;
    }
}

// A law that bends and carries nothing keeps the stiffness that it has at rest; only a contact has none there.
TEST(WithoutLoad, ALawBesideOneThatJumpsKeepsItsStiffness) {
  const Mechanism m = parse_mechanism(R"(
name: foot
kinematics: {family: chains}
leg:
  foot:
    joint: fixed
    tx: {law: hardening, stiffness: 500 N/mm, reference: 0.1 mm}
    ty: {law: linear, stiffness: 300 N/mm}
    tz: {law: clearance, gap: 0.02 mm}
workspace: {cube_edge: 1 mm}
)",
                                      "foot.yaml");
  const Configuration c = configure(m, Pose{});
  Vector6 F = Vector6::Zero();
  F(2) = 50;
  const analytic::AnalyticModel analytic(c);
  frame::MsaModel msa(c);
  const Matrix6 a = analytic.resistance(analytic.solve(F)).K, f = msa.stiffness(msa.solve(F).state).K;
  EXPECT_NEAR(a(0, 0), 5e5, 1e-9 * 5e5);
  EXPECT_NEAR(f(0, 0), 5e5, 1e-9 * 5e5);
}

TEST(Beside, IsNoOverConstraintWhereItYields) {
  const Configuration c = configure(with_friction(2, 1e4), test::home(haptic()));
  EXPECT_EQ(analytic::redundant_constraints(c), 0);
  const Mechanism rigid = test::with(haptic(), "beside", "{rod: {joint: custom, freedoms: ffrfff, at: C, axes: link}}",
                                     Edit::Action::append);
  EXPECT_EQ(analytic::redundant_constraints(configure(rigid, test::home(haptic()))), 6);
}

// The checks of answer.h hold from rest, along a sequence and where it is warm.
TEST(Checks, HoldWithLawsThatJumpAndWithHistory) {
  std::mt19937 random(11);
  Mechanism m = test::with(with_friction(2, 1e4), "leg.ball_joint.tz", "{law: clearance, gap: 0.02 mm}");
  m = test::with(m, "materials.steel.expansion", "12e-6 1/K");
  for (const Pose& pose : test::random_poses(m, 3, 5)) {
    const Configuration c = configure(m, pose);
    AnalyticAt analytic(c);
    MsaAt msa(c);
    Conditions conditions;
    for (int load = 0; load < 4; ++load) {
      const Vector6 F = test::random_wrench(random);
      const Answer a = analytic.answer(F, conditions), f = msa.answer(F, conditions);
      EXPECT_LE(difference(a.displacement, f.displacement), 1e-9);
      conditions.slips = a.slips;
      if (load == 1) conditions.warmer = 15;
    }
  }
}

// At small loads finite geometry is the linear one; a gap closes wherever the load stands.
TEST(FiniteGeometry, KnowsLawsThatJump) {
  std::mt19937 random(13);
  const char* laws[] = {"{law: clearance, gap: 1e-5 mm}", "{law: one_sided, pull: 0.001 mm/N}",
                        "{law: friction, force: 1000 N, stiffness: 1e4 N/mm}",
                        "{law: power, deflection: 1 um, force: 1 N, exponent: 0.3}"};
  std::vector<Mechanism> all = {with_friction(2e-4, 1e4)};
  for (const char* law : laws) all.push_back(test::with(haptic(), "leg.ball_joint.tz", law));
  for (const Mechanism& m : all)
    for (const Pose& pose : test::random_poses(m, 3, 6)) {
      const Vector6 F = 1e-4 * test::random_wrench(random);
      frame::MsaModel msa(configure(m, pose));
      const frame::MsaSolution linear = msa.solve(F);
      ASSERT_TRUE(linear.state.converged);
      for (const Geometry geometry : {Geometry::second_order, Geometry::finite}) {
        const frame::MsaSolution s = msa.solve(F, geometry);
        ASSERT_TRUE(s.state.converged) << s.state.message;
        EXPECT_LE(difference(s.displacement, linear.displacement), 2e-4);
        EXPECT_LE(test::stiffness_difference(msa.stiffness(s.state).K, msa.stiffness(linear.state).K, 0.1), 2e-4);
        for (std::size_t i = 0; i < s.slips.size(); ++i)
          EXPECT_NEAR(s.slips[i], linear.slips[i], 1e-3 * linear.displacement.head<3>().norm());
      }
    }
}

}  // namespace
}  // namespace deflect
