// What each effect of the catalogue is, by elementary mechanics. The leg forces of a 6-PSU follow from statics alone,
// so that by virtual work an effect in series with the legs adds to the displacement along the load
//   F · Δu = Σ_i f_i e_i(f_i),   f_i the force of leg i, tension positive, e_i what the effect adds there.
// The sum is worked out here from positions and forces, without the laws of the program.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>

#include "analytic/model.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"

namespace deflect {
namespace {

using namespace effects;

using test::device;
using test::effect;
using test::values;

struct LegForce {
  double f = 0;  // N, tension positive
  Vector3 n;     // from B to C
  double L1 = 0, L2 = 0;
  double up() const { return f * n.z(); }                   // along the guide
  double across() const { return f * n.head<2>().norm(); }  // across it
};

template <class P>
const P& placed(const PlacedLeg& leg, const std::string& name) {
  for (const PlacedPart& part : leg.parts)
    if (const auto* p = std::get_if<P>(&part); p && p->part == name) return *p;
  throw std::logic_error(name);
}

Matrix6 leg_lines(const Configuration& c) {
  Matrix6 W;
  for (int i = 0; i < 6; ++i) {
    const PlacedLeg& leg = c.legs[static_cast<std::size_t>(i)];
    const Vector3 C = placed<PlacedJoint>(leg, "universal_joint").p_W, B = placed<PlacedJoint>(leg, "ball_joint").p_W;
    const Vector3 n = (C - B).normalized();
    W.col(i) << n, (C - c.pose.p_WT).cross(n);
  }
  return W;
}

std::vector<LegForce> leg_forces(const Configuration& c, const Vector6& F) {
  const Vector6 f = leg_lines(c).partialPivLu().solve(F);
  std::vector<LegForce> out;
  for (int i = 0; i < 6; ++i) {
    const PlacedLeg& leg = c.legs[static_cast<std::size_t>(i)];
    out.push_back({f(i), leg_lines(c).col(i).head<3>(), placed<PlacedMember>(leg, "guideway").length(),
                   placed<PlacedMember>(leg, "link").length()});
  }
  return out;
}

Vector6 displacement(const Mechanism& m, const Pose& pose, const Vector6& F, const Conditions& under = {}) {
  const analytic::AnalyticSolution s = analytic::AnalyticModel(configure(m, pose)).solve(F, under);
  EXPECT_TRUE(s.converged);
  return s.displacement;
}

const double E = 210e9, nu = 0.3, d = 0.008, area = pi / 4 * d * d, I = pi / 64 * std::pow(d, 4);

struct Case {
  const char* effect;
  VectorX values;
  std::function<double(const LegForce&)> work;  // f e(f), J
};

/// Deflection of a spring f = k δ (1 + (δ/r)²), by bisection.
double hardened(double f, double k, double r) {
  double low = 0, high = std::abs(f) / k;
  for (int i = 0; i < 100; ++i) {
    const double x = (low + high) / 2;
    (k * x * (1 + x * x / (r * r)) < std::abs(f) ? low : high) = x;
  }
  return low;
}

std::vector<Case> cases() {
  const double shear = 0.9 * E / (2 * (1 + nu)) * area;  // of a round rod
  return {
      {"actuator_compliance", values({2000}), [](auto& l) { return l.up() * l.up() / 2e6; }},
      {"cable_compliance", values({1e5}), [](auto& l) { return l.up() * l.up() * l.L1 / 1e5; }},
      {"guide_root_compliance", values({5e6}), [](auto& l) { return std::pow(l.across() * l.L1, 2) / 5e3; }},
      {"carriage_compliance", values({2000}), [](auto& l) { return l.across() * l.across() / 2e6; }},
      {"joint_compliance", values({2000}), [](auto& l) { return l.f * l.f / 2e6; }},
      {"hertz_contact", values({5e-4}), [](auto& l) { return 5e-7 * std::pow(std::abs(l.f), 5. / 3); }},
      {"joint_clearance", values({0.01}), [](auto& l) { return 1e-5 * std::abs(l.f); }},
      {"one_sided_actuation", values({5e-4}), [](auto& l) { return l.up() > 0 ? 5e-7 * l.up() * l.up() : 0; }},
      {"guide_diameter", values({0.9}),
       [](auto& l) {
         const double bent = std::pow(l.across(), 2) * std::pow(l.L1, 3) / (3 * E * I),
                      pulled = std::pow(l.up(), 2) * l.L1 / (E * area);
         return bent * (1 / std::pow(0.9, 4) - 1) + pulled * (1 / std::pow(0.9, 2) - 1);
       }},
      {"guideway_shear", values({}), [=](auto& l) { return l.across() * l.across() * l.L1 / shear; }},
      {"actuator_backlash", values({0.01}), [](auto& l) { return 1e-5 * std::abs(l.up()); }},
      {"actuator_hardening", values({1000, 0.02}),
       [](auto& l) { return std::abs(l.up()) * hardened(l.up(), 1e6, 2e-5); }},
  };
}

class EffectPhysics : public ::testing::Test {
 protected:
  /// Calls check(pose, load) at poses and loads of the workspace.
  void at_random(const std::function<void(const Pose&, const Vector6&)>& check) {
    std::mt19937 random(4);
    for (const Pose& pose : test::random_poses(m, 5)) check(pose, test::random_wrench(random));
  }
  /// F · Δu, J.
  double added_work(const Mechanism& with, const Pose& pose, const Vector6& F) {
    return F.dot(displacement(with, pose, F) - displacement(m, pose, F));
  }
  const Mechanism m = device("haptic-6psu-ideal-joints");
};

// Both sides round in sums of some hundred terms that are large against Δu: 1e-9 of the whole work.
const double rounding = 1e-9;

TEST_F(EffectPhysics, AddsItsWorkInTheLegs) {
  for (const Case& each : cases()) {
    const Mechanism with = with_effect(m, effect(each.effect), each.values);
    at_random([&](const Pose& pose, const Vector6& F) {
      double expected = 0;
      for (const LegForce& leg : leg_forces(configure(m, pose), F)) expected += each.work(leg);
      EXPECT_NEAR(added_work(with, pose, F), expected, rounding * F.dot(displacement(m, pose, F))) << each.effect;
    });
  }
}

TEST_F(EffectPhysics, OfOneLegAddsItsWorkThere) {
  const Mechanism softer = with_effect(m, effect("leg_joint_compliance"), values({2000}), 4),
                  thinner = with_effect(m, effect("leg_defect"), values({0.7}), 4);
  at_random([&](const Pose& pose, const Vector6& F) {
    const LegForce leg = leg_forces(configure(m, pose), F)[3];
    const double scale = rounding * F.dot(displacement(m, pose, F));
    EXPECT_NEAR(added_work(softer, pose, F), leg.f * leg.f / 2e6, scale);
    const double bent = std::pow(leg.across(), 2) * std::pow(leg.L1, 3) / (3 * E * I);
    EXPECT_NEAR(added_work(thinner, pose, F), bent * (1 / 0.7 - 1), scale);
  });
}

/// A cylinder and its rod are two bars on one line, in which the joints' spring stands once: it moves the tool as the
/// same spring in the drive does, which both carry.
TEST(EffectPhysicsOfACylinder, TheJointsYieldOnceAlongTheLegsLine) {
  const Mechanism stewart = device("stewart-6ups"),
                  joints = with_effect(stewart, effect("joint_compliance"), values({2000})),
                  drives = with_effect(stewart, effect("actuator_compliance"), values({2000}));
  const Pose pose = home_pose(stewart);
  const Vector6 F = (Vector6() << 30, -25, 31, 0.5, -1, 0.75).finished();
  const Vector6 moved = displacement(joints, pose, F);
  EXPECT_LE((moved - displacement(drives, pose, F)).norm(), 1e-9 * moved.norm());
  EXPECT_GT((moved - displacement(stewart, pose, F)).norm(), 0.1 * moved.norm()) << "the test shows nothing";
}

TEST_F(EffectPhysics, OfPlatformBaseAndToolAddsItsWorkThere) {
  const Mechanism platform = with_effect(m, effect("platform_flexibility"), values({2000})),
                  tilt = with_effect(m, effect("base_tilt"), values({1e8})),
                  shift = with_effect(m, effect("base_compliance"), values({3000, 5000})),
                  tool = with_effect(m, effect("tool_compliance"), values({3000, 5000}));
  at_random([&](const Pose& pose, const Vector6& F) {
    const double scale = rounding * F.dot(displacement(m, pose, F));
    double normal = 0;
    for (const LegForce& leg : leg_forces(configure(m, pose), F))
      normal += std::pow(leg.f * leg.n.dot(pose.R_WT.col(2)), 2) / 2e6;
    EXPECT_NEAR(added_work(platform, pose, F), normal, scale);
    const Vector3 f = F.head<3>(), moment = F.tail<3>() + pose.p_WT.cross(f), in_tool = pose.R_WT.transpose() * f;
    EXPECT_NEAR(added_work(tilt, pose, F), moment.head<2>().squaredNorm() / 1e5, scale);
    EXPECT_NEAR(added_work(shift, pose, F), f.head<2>().squaredNorm() / 3e6 + f.z() * f.z() / 5e6, scale);
    EXPECT_NEAR(added_work(tool, pose, F), in_tool.head<2>().squaredNorm() / 3e6 + std::pow(in_tool.z(), 2) / 5e6,
                scale);
  });
}

TEST_F(EffectPhysics, ModulusScalesEverythingAndWeightIsALoad) {
  const Mechanism softer = with_effect(m, effect("modulus"), values({0.8})),
                  heavy = with_effect(m, effect("self_weight"), values({0.5}));
  at_random([&](const Pose& pose, const Vector6& F) {
    const Vector6 u = displacement(m, pose, F);
    EXPECT_LT((displacement(softer, pose, F) - u / 0.8).norm(), rounding * u.norm());
    Vector6 both = F;
    both(2) -= 0.5 * 9.80665;
    EXPECT_LT((displacement(heavy, pose, F) - displacement(m, pose, both)).norm(), rounding * u.norm());
  });
}

TEST_F(EffectPhysics, HeatLengthensGuidewaysAndLinks) {
  const Mechanism warm = with_effect(m, effect("thermal_expansion"), values({1.2e-5}));
  Conditions under;
  under.warmer = 10;
  at_random([&](const Pose& pose, const Vector6& F) {
    double expected = 0;
    for (const LegForce& leg : leg_forces(configure(m, pose), F))
      expected += 1.2e-4 * (leg.f * leg.L2 + leg.up() * leg.L1);
    const double added = F.dot(displacement(warm, pose, F, under) - displacement(m, pose, F));
    EXPECT_NEAR(added, expected, rounding * F.dot(displacement(m, pose, F)));
    EXPECT_LT((displacement(warm, pose, F) - displacement(m, pose, F)).norm(), 1e-15);
  });
}

TEST_F(EffectPhysics, FrictionThatSlipsTakesAConstantForceFromEveryLeg) {
  const double force = 0.02;  // so little that every leg slips
  const Mechanism with = with_effect(m, effect("joint_friction"), values({force, 1e5}));
  at_random([&](const Pose& pose, const Vector6& F) {
    const Configuration c = configure(m, pose);
    const Vector6 u = displacement(m, pose, F);
    Vector6 held = Vector6::Zero();
    for (int i = 0; i < 6; ++i) {
      const Vector6 line = leg_lines(c).col(i);
      const double longer = line.dot(u);  // how far C moves along the leg
      ASSERT_GT(std::abs(longer), 10 * force / 1e8);
      held += force * (longer > 0 ? 1 : -1) * line;
    }
    EXPECT_LT((displacement(with, pose, F) - displacement(m, pose, F - held)).norm(), rounding * u.norm());
  });
}

// Beside the limit at which an effect is absent, its part is small in proportion: 1e-6 of the way from there to the
// start (or a million times the start, where the limit is infinite) leaves at most ten times that of its part. The way
// that a small preload takes in a Hertz contact goes with its power 2/3.
TEST(EffectLimits, TheEffectFadesInProportion) {
  for (const char* name : {"haptic-6psu", "haptic-6psu-ideal-joints"}) {
    const Mechanism m = device(name);
    const Pose pose = test::random_poses(m, 1)[0];
    std::mt19937 random(4);
    const Vector6 F = test::random_wrench(random), u = displacement(m, pose, F);
    for (const Effect& e : test::all_effects()) {
      if (why_not(e, m) || e.parameters.empty()) continue;
      const double near = 1e-6;
      VectorX x = start_values(e);
      const auto part = [&] {
        return (displacement(with_effect(m, e, x, test::some_leg(e)), pose, F) - u).norm() / u.norm();
      };
      const double whole = part();
      for (std::size_t i = 0; i < e.parameters.size(); ++i) {
        double& value = x(static_cast<Eigen::Index>(i));
        const auto& limit = e.parameters[i].vanishes;
        if (limit) value = std::isfinite(*limit) ? *limit + near * (value - *limit) : value / near;
      }
      EXPECT_LE(part(), 10 * std::pow(near, e.name == "joint_preload" ? 2. / 3 : 1) * whole + 1e-9)
          << e.name << " in " << name << ", at its start " << whole;
      const bool seen = e.scope != Scope::rig && e.name != "thermal_expansion";
      EXPECT_EQ(whole > 1e-6, seen) << e.name << " in " << name;
    }
  }
}

}  // namespace
}  // namespace deflect
