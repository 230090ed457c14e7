// The two theories against each other, against the table of the paper's device and against symmetry.
#include "validation/studies/errata_prices.h"
#include "validation/studies/validate.h"
#include "validation/theories/agreement.h"

#include <gtest/gtest.h>

#include "analytic/model.h"
#include "msa/base/stiffness_checks.h"
#include "msa/frame/laws/component.h"
#include "msa/frame/mechanism/msa.h"
#include "tests/support/devices.h"
#include "tests/support/theories.h"
#include "validation/studies/solve.h"
#include "validation/studies/workspace.h"

namespace deflect {
namespace {

using namespace studies;
using namespace theories;

using test::device;

const frame::MemberDivision four_each = {{"guideway", {0, 0.25, 0.5, 0.75, 1}}, {"link", {0, 0.25, 0.5, 0.75, 1}}};

/// Largest relative difference of displacements and of stiffnesses over random poses under random wrenches.
double worst_difference(const Mechanism& m, int poses, const frame::MemberDivision& division = {}) {
  std::mt19937 random(11);
  double worst = 0;
  for (const Pose& pose : test::random_poses(m, poses)) {
    const Configuration c = configure(m, pose);
    const analytic::AnalyticModel a(c);
    frame::MsaModel f(c, division);
    const Vector6 F = test::random_wrench(random);
    const analytic::AnalyticSolution s = a.solve(F);
    const frame::MsaSolution r = f.solve(F);
    EXPECT_TRUE(s.converged && r.state.converged);
    worst = std::max(worst, relative_difference(twist_in_mm(s.displacement), twist_in_mm(r.displacement)));
    const Matrix6 K = stiffness_in_mm(f.stiffness(r.state).K);
    worst = std::max(worst, (stiffness_in_mm(a.stiffness(s)) - K).norm() / K.norm());
  }
  return worst;
}

// Displacement along a 50 N load in mm at the nine points, links only, ideal joints, from the leg as a two-force member
// (statics alone); given to six decimals.
constexpr double closed_form[9][3] = {
    {0.084092, 0.084092, 0.026865}, {0.703127, 0.604736, 0.055196}, {0.477092, 0.557969, 0.098311},
    {0.477092, 0.557969, 0.098311}, {0.703127, 0.604736, 0.055196}, {0.204568, 0.174057, 0.009520},
    {0.124437, 0.139384, 0.019823}, {0.124437, 0.139384, 0.019823}, {0.204568, 0.174057, 0.009520}};

TEST(NinePoints, IdealJointsGiveTheClosedFormTableByBothTheories) {
  const Mechanism m = device("haptic-6psu-ideal-joints");
  const Validation v = validate(m, workspace_points(m), 50, {}, four_each);
  ASSERT_EQ(v.rows.size(), 27u);
  for (std::size_t i = 0; i < 27; ++i) {
    EXPECT_NEAR(test::analytic(v.rows[i])(v.rows[i].axis), closed_form[i / 3][i % 3], 0.51e-6) << i;
    EXPECT_NEAR(test::msa(v.rows[i])(v.rows[i].axis), closed_form[i / 3][i % 3], 0.51e-6) << i;
  }
  EXPECT_LT(v.max_relative_difference, 1e-9);
}

TEST(NinePoints, ContactLawsAgreeAndSoftenEveryPoint) {
  const Mechanism m = device("haptic-6psu");
  const Validation v = validate(m, workspace_points(m), 50, {}, four_each);
  EXPECT_LT(v.max_relative_difference, 1e-7);
  for (std::size_t i = 0; i < 27; ++i) EXPECT_GT(test::analytic(v.rows[i])(v.rows[i].axis), closed_form[i / 3][i % 3]);
}

// The paper: x and y are soft at points 1–4, where the guideways are long; z is several times smaller there.
TEST(NinePoints, PointsOneToFourAreSoftInXAndY) {
  const Mechanism m = device("haptic-6psu");
  const Validation v = validate(m, workspace_points(m), 50, {}, {});
  for (const std::size_t axis : {0u, 1u})
    for (std::size_t upper = 1; upper <= 4; ++upper) {
      for (const std::size_t other : {0u, 5u, 6u, 7u, 8u})
        EXPECT_GT(test::msa(v.rows[3 * upper + axis])(static_cast<int>(axis)),
                  2 * test::msa(v.rows[3 * other + axis])(static_cast<int>(axis)));
      EXPECT_GT(test::msa(v.rows[3 * upper + axis])(static_cast<int>(axis)), 4 * test::msa(v.rows[3 * upper + 2])(2));
    }
}

TEST(BothTheories, AgreeAtTiltedPosesUnderForcesAndMoments) {
  EXPECT_LT(worst_difference(device("haptic-6psu-ideal-joints"), 200), 1e-9);
  EXPECT_LT(worst_difference(device("haptic-6psu"), 200), 1e-7);
}

TEST(BothTheories, DoNotDependOnTheMesh) { EXPECT_LT(worst_difference(device("haptic-6psu"), 20, four_each), 1e-7); }

/// Every elastic site and law of the description, switched on in turn; linear laws must agree to 1e-9, contacts to
/// 1e-7.
struct Site {
  const char* name;
  const char* path;
  const char* value;
  double tolerance = 1e-9;
  bool stiffens = false;  ///< a law on a freedom that was free
  friend void PrintTo(const Site& site, std::ostream* out) { *out << site.path << ": " << site.value; }
};

class EverySite : public ::testing::TestWithParam<Site> {};

TEST_P(EverySite, BothTheoriesAgreeAndTheDeviceFeelsIt) {
  const Mechanism ideal = device("haptic-6psu-ideal-joints");
  const Mechanism edited = test::with(ideal, GetParam().path, GetParam().value);
  EXPECT_LT(worst_difference(edited, 20), GetParam().tolerance);
  const Vector6 F = (Vector6() << 30, -20, 40, 0.3, 0.5, -0.4).finished();
  const auto work = [&](const Mechanism& m) {
    return F.dot(analytic::AnalyticModel(configure(m, test::random_poses(m, 1).front())).solve(F).displacement);
  };
  if (GetParam().stiffens)
    EXPECT_LT(work(edited), work(ideal) * (1 - 1e-6));
  else
    EXPECT_GT(work(edited), work(ideal) * (1 + 1e-6));
}

INSTANTIATE_TEST_SUITE_P(
    Sites, EverySite,
    ::testing::Values(
        Site{"ActuatorLinear", "leg.actuator.tz", "{law: linear, stiffness: 500 N/mm}"},
        Site{"ActuatorShaft", "leg.actuator.tz",
             "{law: motor_shaft, material: steel, diameter: 4 mm, length: 30 mm, pulley_radius: 8 mm}"},
        Site{"ActuatorCable", "leg.actuator.tz", "{law: cable, material: steel, area: 0.5 mm^2}"},
        Site{"ActuatorCablePair", "leg.actuator.tz",
             "{law: cable_pair, material: steel, area_1: 0.5 mm^2, length_1: 90 mm, area_2: 0.3 mm^2, length_2: 140 "
             "mm}"},
        Site{"ActuatorBelt", "leg.actuator.tz",
             "{law: belt, specific_stiffness: 900 N/mm, width: 6 mm, tight_length: 90 mm, slack_length: 200 mm}"},
        Site{"ShaftAndCableInSeries", "leg.actuator.tz",
             "[{law: motor_shaft, material: steel, diameter: 4 mm, length: 30 mm, pulley_radius: 8 mm}, "
             "{law: cable, material: steel, area: 0.5 mm^2}]"},
        Site{"BeltOnAPulley", "leg.actuator.rx",
             "{law: belt, specific_stiffness: 900 N/mm, width: 6 mm, tight_length: 90 mm, slack_length: 200 mm, "
             "pulley_radius: 20 mm}"},
        Site{"GuideRoot", "leg.actuator.rx", "{law: linear, stiffness: 5e6 Nmm/rad}"},
        Site{"Carriage", "leg.carriage.tx", "{law: linear, stiffness: 800 N/mm}"},
        Site{"BallContact", "leg.ball_joint.tz", "{law: hertz_point, material: steel, radius: 4 mm}", 1e-7},
        Site{"PinContactWithBulk", "leg.universal_joint.tz",
             "{law: hertz_line_bulk, material: steel, radius_1: 3 mm, radius_2: 3 mm, length: 10 mm}", 1e-7},
        Site{"BallFlexure", "leg.ball_joint.rx", "{law: linear, stiffness: 1e5 Nmm/rad}", 1e-9, true},
        Site{"UniversalSpin", "leg.universal_joint.rx", "{law: linear, stiffness: 1e5 Nmm/rad}", 1e-9, true},
        Site{"PlatformMount", "leg.mount.tz", "{law: linear, stiffness: 3000 N/mm}"},
        Site{"BaseTilt", "base.rx", "{law: linear, stiffness: 3e7 Nmm/rad}"},
        Site{"BaseContact", "base.tz", "{law: hertz_point, material: steel, radius: 40 mm}", 1e-7},
        Site{"Tool", "tool.tx", "{law: linear, stiffness: 2000 N/mm}"},
        Site{"Timoshenko", "leg.guideway.beam", "timoshenko"}, Site{"Modulus", "materials.steel.E", "190 GPa"},
        Site{"Tube", "sections.guide_rod", "{shape: tube, outer_diameter: 8 mm, inner_diameter: 5 mm}"},
        Site{"Flat", "sections.guide_rod", "{shape: rectangle, width_y: 6 mm, height_z: 7 mm}"},
        Site{"OneLeg", "leg[4].guideway.bending_factor", "0.6"}),
    [](const auto& site) { return std::string(site.param.name); });

TEST(BothTheories, FlexuresInPassiveJointsMakeLegsCarryMomentsAndStillAgree) {
  Mechanism m = device("haptic-6psu");
  for (const char* freedom : {"rx", "ry", "rz"})
    m = test::with(m, std::string("leg.ball_joint.") + freedom, "{law: linear, stiffness: 2e5 Nmm/rad}");
  EXPECT_LT(worst_difference(m, 30), 1e-7);  // not determinate any more: Newton has work to do
}

TEST(Symmetry, AThirdOfATurnTurnsTheResult) {
  const Mechanism m = device("haptic-6psu");
  const Matrix3 third = rotation_from_rpy(0, 0, 2 * pi / 3);
  const Vector6 F = (Vector6() << 30, -20, 40, 0.3, 0.5, -0.4).finished();
  for (const Pose& pose : test::random_poses(m, 10)) {
    const Pose turned{third * pose.p_WT, third * pose.R_WT * third.transpose()};
    const Vector6 F_turned = rotate_twist(third) * F;
    const Vector6 a = rotate_twist(third) * analytic::AnalyticModel(configure(m, pose)).solve(F).displacement;
    const Vector6 b = analytic::AnalyticModel(configure(m, turned)).solve(F_turned).displacement;
    EXPECT_LE((a - b).norm(), 1e-12 * a.norm());
    frame::MsaModel f(configure(m, turned));
    EXPECT_LE((f.solve(F_turned).displacement - a).norm(), 1e-10 * a.norm());
  }
}

TEST(Checks, HoldAtEveryPoseForBothTheories) {
  for (const char* name : {"haptic-6psu", "haptic-6psu-ideal-joints"}) {
    const Mechanism m = device(name);
    std::mt19937 random(2);
    for (const Pose& pose : test::random_poses(m, 25)) {
      const SolveResult r =
          solve(m, stand(m, mm_deg_from(pose)), Vector6::Unit(0) * 10, {});  // throws where a check fails
      EXPECT_TRUE(r.symmetric && r.positive && r.passive_joints_free);
    }
  }
}

TEST(Solve, SharesAreTheSameByBothTheoriesAndSumToOne) {
  const Mechanism m = device("haptic-6psu");
  const Configuration c = configure(m, test::home(m));
  const Vector6 F = Vector6::Unit(0) * 50;
  const analytic::AnalyticModel a(c);
  const auto analytic = a.energies(a.solve(F));
  const SolveResult r = solve(m, stand(m, mm_deg_from(test::home(m))), F, {});
  ASSERT_EQ(r.shares.size(), analytic.size());
  double sum = 0, total = 0;
  for (const auto& [part, energy] : analytic) total += energy;
  for (std::size_t i = 0; i < analytic.size(); ++i) {
    EXPECT_EQ(r.shares[i].first, analytic[i].first);
    EXPECT_NEAR(r.shares[i].second, analytic[i].second / total, 1e-9);
    sum += r.shares[i].second;
  }
  EXPECT_NEAR(sum, 1, 1e-14);
  EXPECT_EQ(r.shares.front().first, "guideway");
}

TEST(Solve, DisplacementFollowsFromTheStiffnessOfTheLinearDevice) {
  const Mechanism m = device("haptic-6psu-ideal-joints");
  const Vector6 F = (Vector6() << 10, 20, -30, 500, -200, 300).finished();  // N, Nmm
  const SolveResult r = solve(m, stand(m, mm_deg_from(test::random_poses(m, 1).front())), F, {});
  for (const TheorySolution* s : {&test::analytic(r), &test::msa(r)})
    EXPECT_LE((s->stiffness_mm * s->displacement_mm_rad - F).norm(), 1e-9 * F.norm());
}

TEST(Solve, WithoutLoadContactsHaveNoStiffnessByBothTheories) {
  const Mechanism m = device("haptic-6psu");
  const SolveResult r = solve(m, stand(m, mm_deg_from(test::home(m))), Vector6::Zero(), {});
  EXPECT_TRUE(test::analytic(r).stiffness_mm.isZero(1e-9));
  EXPECT_TRUE(test::msa(r).stiffness_mm.isZero(1e-6));
  EXPECT_TRUE(test::analytic(r).displacement_mm_rad.isZero(0) && test::msa(r).displacement_mm_rad.isZero(0));
}

TEST(Solve, ReactionsOfTheBaseBalanceTheLoad) {
  const Mechanism m = device("haptic-6psu");
  const Pose pose = test::random_poses(m, 1).front();
  frame::MsaModel f(configure(m, pose));
  const Vector6 F = (Vector6() << 30, -20, 40, 0.3, 0.5, -0.4).finished();
  const frame::MsaSolution s = f.solve(F);
  const Vector6 R = f.base_reaction(F, s.state);
  EXPECT_LE((R + shift_twist(pose.p_WT).transpose() * F).norm(), 1e-10 * F.norm());
}

// Legs whose platform joint holds nothing about the leg's own spin and ball joints at both ends: each link would spin.
TEST(Refusal, APlatformThatNoLegHoldsIsRefusedByBothTheories) {
  Mechanism m = device("haptic-6psu-ideal-joints");
  m = test::with(m, "leg.mount.joint", "slider");  // every leg slides along the platform's normal: z is free
  const Configuration c = configure(m, test::home(m));
  EXPECT_THROW(analytic::AnalyticModel(c).solve(Vector6::Unit(2)), ModelError);
  EXPECT_THROW(analytic::AnalyticModel(c).solve(Vector6::Unit(0)), ModelError);
  EXPECT_THROW(frame::MsaModel(c).solve(Vector6::Unit(2)), ModelError);
  EXPECT_THROW(frame::MsaModel(c).solve(Vector6::Unit(0)), ModelError);  // whatever the load
}

// The check K_c J_q = 0 is worth nothing if K_c misses what a leg does: side by side, the legs must make up the whole,
// also where the spring at the platform is so stiff that it has coordinates of its own.
TEST(Checks, LegsSideBySideSumToTheStiffness) {
  const Mechanism ideal = device("haptic-6psu-ideal-joints");
  for (const char* mount : {"3e3 N/mm", "1e9 N/mm", "1e14 N/mm"}) {
    Mechanism m = ideal;
    for (const char* site : {"leg.mount.tz", "leg.universal_joint.tz"})
      m = test::with(m, site, fmt::format("{{law: linear, stiffness: {}}}", mount));
    frame::MsaModel f(configure(m, test::random_poses(m, 1).front()));
    const frame::MsaModel::Stiffness s = f.stiffness(f.solve(Vector6::Unit(0) * 50).state);
    Matrix6 sum = Matrix6::Zero();
    for (const Matrix6& leg : s.legs) sum += leg;
    EXPECT_LE((sum - s.K).norm(), 1e-9 * s.K.norm()) << mount;
  }
}

// A ball joint at both ends lets every link spin about its own axis: harmless, and said so.
TEST(IdleSpin, ChangesNoAnswerAndIsNoted) {
  const Mechanism m = device("haptic-6psu"), balls = test::with(m, "leg.universal_joint.joint", "ball");
  const Vector6 F = (Vector6() << 30, -20, 40, 300, 500, -400).finished();
  for (const Pose& pose : test::random_poses(m, 5)) {
    const SolveResult held = solve(m, stand(m, mm_deg_from(pose)), F, {}),
                      spinning = solve(balls, stand(balls, mm_deg_from(pose)), F, {});
    EXPECT_LT(spinning.relative_difference, 1e-7);
    EXPECT_LT(relative_difference(test::msa(spinning).displacement_mm_rad, test::msa(held).displacement_mm_rad), 1e-10);
    EXPECT_LT(
        relative_difference(test::analytic(spinning).displacement_mm_rad, test::analytic(held).displacement_mm_rad),
        1e-10);
    EXPECT_TRUE(held.notes.empty());
    ASSERT_EQ(spinning.notes.size(), 6u);
    EXPECT_NE(spinning.notes[0].find("link spins idly about its own axis: harmless, held"), std::string::npos);
  }
}

TEST(RelativeDifference, TakesTheWorseOfTranslationAndRotation) {
  Vector6 a = (Vector6() << 1, 0, 0, 0.01, 0, 0).finished(), b = a;
  EXPECT_EQ(relative_difference(a, b), 0);
  a(0) = 1.001;
  EXPECT_NEAR(relative_difference(a, b), 1e-3, 1e-12);
  a(3) = 0.0102;
  EXPECT_NEAR(relative_difference(a, b), 2e-2, 1e-12);
  b.tail<3>().setZero();
  a = b;
  a(4) = 1e-16;  // rounding where there is no rotation
  EXPECT_LT(relative_difference(a, b), 1e-3);
}

// Locking joints can only stiffen (Rayleigh), and the check of the passive joints must see it.
TEST(Errata, LockedPassiveJointsStiffenEveryPointAndAreSeen) {
  for (const char* name : {"haptic-6psu", "haptic-6psu-ideal-joints"}) {
    const Mechanism m = device(name);
    const std::vector<ErratumPrice> prices = price_errata(m, workspace_points(m), 50);
    const auto price = std::find_if(prices.begin(), prices.end(),
                                    [](const ErratumPrice& p) { return p.erratum == Erratum::passive_joints; });
    EXPECT_LT(price->largest.maxCoeff(), 0.7);
    EXPECT_GT(price->smallest.minCoeff(), 0.1);
    EXPECT_NE(price->failed_check.find("K_c J_q = 0"), std::string::npos);
  }
}

TEST(Errata, AreEachFeltAndNoneTouchesTheCorrectedTheory) {
  const Mechanism m = device("haptic-6psu");
  const Validation plain = validate(m, workspace_points(m), 50, {}, {});
  const Validation printed =
      validate(m, workspace_points(m), 50, {Erratum::ujoint_parallel, Erratum::contact_modulus}, {});
  for (std::size_t i = 0; i < plain.rows.size(); ++i) {
    EXPECT_EQ(test::analytic(plain.rows[i]), test::analytic(printed.rows[i]));
    ASSERT_TRUE(printed.rows[i].as_printed);
    EXPECT_NE(*printed.rows[i].as_printed, test::analytic(printed.rows[i]));
  }
}

TEST(CubePoints, WithoutAWorkspaceThereAreNone) {
  const Mechanism m = parse_mechanism(
      "{name: post, kinematics: {family: chains}, materials: {steel: {E: 210 GPa, nu: 0.3}}, sections: {rod: {shape: "
      "round, diameter: 8 mm}}, leg: {post: {member: rod, material: steel, along: [0 mm, 0 mm, 100 mm]}}}",
      "post");
  try {
    workspace_points(m);
    FAIL() << "nine equal points are no validation";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("workspace: {cube_edge: 50 mm}"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace deflect
