// Laws that jump, in the deformed shape. A load may leave play open in linear geometry, which then says nothing about
// where in it the machine stands; the forces of second order do.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "analytic/model.h"
#include "msa/frame/mechanism/msa.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "tests/support/mechanisms.h"
#include "validation/effects/place_effects.h"
#include "validation/studies/solve.h"
#include "validation/studies/workspace.h"

namespace deflect {
namespace {

using namespace studies;

constexpr double L = 0.3;

Vector6 by_closed_form(const Configuration& c, const Vector6& F) {
  const analytic::AnalyticSolution s = analytic::AnalyticModel(c).solve(F, Geometry::finite);
  EXPECT_TRUE(s.converged) << s.message;
  EXPECT_FALSE(s.apart);
  EXPECT_TRUE(s.loose.empty());
  return s.displacement;
}

Vector6 by_msa(const Configuration& c, const Vector6& F, int elements = 1) {
  frame::MsaModel model(c, frame::equal_division(c, elements));
  const frame::MsaSolution s = model.solve(F, Geometry::finite);
  EXPECT_TRUE(s.state.converged) << s.state.message;
  return s.displacement;
}

// A load cell that reads zero before and after each series: no rounding of no force may push play to one side.
TEST(JumpsInShape, WithoutALoadPlayStandsInItsMiddle) {
  const Mechanism arm = test::device("arm");
  for (const char* joint : {"1", "2", "3", "4", "5", "6"}) {
    const Mechanism m = edited(
        arm, {std::string("leg.joint_") + joint + ".rz", "{law: clearance, gap: 0.7 mrad}", Edit::Action::append});
    const Configuration c = configure(m, home_pose(m));
    const Vector6 none = Vector6::Zero();
    const analytic::AnalyticModel model(c);
    for (const Geometry geometry : {Geometry::second_order, Geometry::finite}) {
      EXPECT_EQ(model.solve(none, geometry).displacement, none) << joint;
      EXPECT_FALSE(model.solve(none, geometry).loose.empty()) << joint;
      EXPECT_EQ(model.displaced(none, geometry).displacement, none) << joint;
      EXPECT_EQ(frame::MsaModel(c).solve(none, geometry).displacement, none) << joint;
    }
  }
}

// A hinge that yields about y carries a slide with play ±g along its arm, loaded across the arm. In linear geometry no
// force acts along it. The hinge turns by θ, the load F then pulls along the arm by F sin θ > 0 whichever sign it has,
// and the play stands at its outer end: k θ = F (L + g) cos θ.
TEST(JumpsInShape, ALoadAcrossAnArmPullsItsPlayOutwards) {
  constexpr double k = 100, g = 1e-3;
  const PlacedJoint hinge = test::spring("hinge", Vector3::Zero(), {{4, k}});
  PlacedJoint slide = test::joint("slide", {L, 0, 0}, "rrrrrr");
  slide.laws[0] = {ClearanceLaw{g}};
  const Configuration c = test::configuration({L, 0, 0}, {{"arm", {hinge, slide}}}, L);
  for (const double F : {20.0, -20.0, 3.0}) {
    double theta = 0;  // about −y
    for (int i = 0; i < 100; ++i) theta = F * (L + g) * std::cos(theta) / k;
    const Vector3 by_hand = {(L + g) * std::cos(theta) - L, 0, (L + g) * std::sin(theta)};
    for (const Vector6& found : {by_closed_form(c, F * Vector6::Unit(2)), by_msa(c, F * Vector6::Unit(2))}) {
      EXPECT_LE((found.head<3>() - by_hand).norm(), 1e-9 * by_hand.norm()) << F;
      EXPECT_NEAR(found(4), -theta, 1e-9) << F;
    }
    const Vector6 for_fits = analytic::AnalyticModel(c).displaced(F * Vector6::Unit(2), Geometry::finite).displacement;
    EXPECT_LE((for_fits.head<3>() - by_hand).norm(), 1e-9 * by_hand.norm()) << F;
  }
}

// A pendulum whose hinge has play ±γ hangs along its load, which is within the play: it stands at neither end. Linear
// geometry puts it to the end towards which the load has a moment.
TEST(JumpsInShape, APendulumStandsWithinItsPlay) {
  constexpr double gamma = 0.02;
  PlacedJoint hinge = test::joint("hinge", Vector3::Zero(), "rrrrrr");
  hinge.laws[4] = {ClearanceLaw{gamma}};
  const PlacedJoint spring = test::spring("spring", {0, 0, -L}, {{3, 50}});
  const Configuration c = test::configuration({0, 0, -L}, {{"arm", {hinge, spring}}}, L);
  for (const double aside : {0.5, -0.2, 2.0}) {
    const Vector6 F = aside * Vector6::Unit(0) - 50 * Vector6::Unit(2);
    const double turn = -std::clamp(std::atan2(aside, 50), -gamma, gamma);
    for (const Vector6& found : {by_closed_form(c, F), by_msa(c, F)}) {
      EXPECT_NEAR(found(4), turn, 1e-8) << aside;
      EXPECT_NEAR(found(0), -L * std::sin(turn), 1e-8 * L) << aside;
    }
  }
}

// A post with play ±γ at its foot carries the load on a pendulum with play ±2γ at its head: z_T = L (2 cos α − cos(α +
// β)). The load pushes the post to the end of its play to which it has a moment, and away from its middle; the pendulum
// hangs along the load, within its play.
TEST(JumpsInShape, APendulumOnAPostHangsWhereThePostStands) {
  constexpr double gamma = 1e-4;
  PlacedJoint foot = test::joint("foot", Vector3::Zero(), "rrrrrr");
  foot.laws[4] = {ClearanceLaw{gamma}};
  PlacedJoint head = test::joint("head", {0, 0, 2 * L}, "rrrrrr");
  head.laws[4] = {ClearanceLaw{2 * gamma}};
  const PlacedJoint spring = test::spring("spring", {0, 0, L}, {{3, 50}});
  const Configuration c = test::configuration({0, 0, L}, {{"arm", {foot, head, spring}}}, L);
  for (const double size : {50.0, 1.0, 0.1})
    for (const double tilt : {1e-6, -1e-5, 4e-5}) {
      const Vector6 F = size * (std::sin(tilt) * Vector6::Unit(0) - std::cos(tilt) * Vector6::Unit(2));
      const double alpha = tilt > 0 ? gamma : -gamma, both = -tilt;  // about y
      const double x = 2 * L * std::sin(alpha) - L * std::sin(both);
      const Vector6 for_fits = analytic::AnalyticModel(c).displaced(F, Geometry::finite).displacement;
      for (const Vector6& found : {by_closed_form(c, F), by_msa(c, F), for_fits}) {
        EXPECT_NEAR(found(4), both, 1e-8 / L) << tilt;
        EXPECT_NEAR(found(0), x, 1e-8) << tilt;
      }
    }
}

// A law that yields alike to both sides, and a friction that sticks, are springs under another name. The closed form
// divides members until it estimates that 1e-6 is left.
TEST(JumpsInShape, ALawThatDoesNotJumpIsASpring) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  const auto hinged = [&](const char* law) {
    return configure(test::with(m, "leg.actuator.ry", law),
                     stand(m, workspace_points(m)[3].pose_mm_deg).configuration.pose);
  };
  const Configuration spring = hinged("{law: linear, stiffness: 1e5 Nmm/rad}");
  const Configuration others[] = {hinged("{law: one_sided, pull: 0.01 rad/Nm, push: 0.01 rad/Nm}"),
                                  hinged("{law: friction, moment: 1e6 Nmm, stiffness: 1e5 Nmm/rad}")};
  Vector6 F;
  F << 30, -20, 35, 0.4, 0.3, -0.5;
  for (const double share : {1.0, 0.01})
    for (const Geometry geometry : {Geometry::second_order, Geometry::finite})
      for (const theories::Theory* theory : theories::all_theories()) {
        const auto displaced = [&](const Configuration& c) {
          return theory->at(c, {m.name, frame::equal_division(c, 4)})->predict(share * F, geometry).displacement;
        };
        const Vector6 by_spring = displaced(spring);
        for (const Configuration& c : others)
          EXPECT_LE((displaced(c) - by_spring).norm(), (theory->divides ? 1e-9 : 1e-6) * by_spring.norm())
              << theory->name;
      }
}

class PlayInDrives : public ::testing::TestWithParam<std::string> {};

// Up to what dividing members leaves: 1e-6, as estimated by each.
TEST_P(PlayInDrives, StandsWhereBothTheoriesSay) {
  const effects::Effect& play = test::effect("actuator_backlash");
  const Mechanism m = effects::with_effect(test::device(GetParam()), play, VectorX::Constant(1, 0.02));
  for (const ValidationPoint& point : workspace_points(m)) {
    const auto there = stand(m, point.pose_mm_deg);
    for (Eigen::Index i = 0; i < 3; ++i) {
      EXPECT_FALSE(analytic::AnalyticModel(there.configuration).solve(50 * Vector6::Unit(i), Geometry::finite).apart);
      const SolveResult found = solve(m, there, 50 * Vector6::Unit(i), {}, Geometry::finite);
      EXPECT_LE(found.relative_difference, 1e-6 + 10 * found.discretisation) << point.label << " along " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Devices, PlayInDrives,
                         ::testing::Values("tripteron", "haptic-6psu", "stewart-6ups", "scara", "gantry", "3-upu"));

/// With play of one size at the place, in all of a machine's legs or stages.
Mechanism with_play(const Mechanism& drawn, const std::string& at, double gap) {
  const std::vector<effects::Effect> all = effects::place_effects(subject::Subject(drawn), test::all_effects());
  const auto play = std::find_if(all.begin(), all.end(), [&](const effects::Effect& e) {
    return e.name == "clearance@" + at && e.scope != effects::Scope::one_leg;
  });
  EXPECT_NE(play, all.end()) << at;
  return play == all.end() ? drawn : effects::with_effect(drawn, *play, VectorX::Constant(1, gap));
}

// Play across both joints of a leg: a leg that is pressed leans as far as it can, one that is pulled hangs in line with
// its force, held by the load alone.
TEST(JumpsInShape, PulledLegsHangWithinThePlayOfTheirJoints) {
  const Mechanism m = with_play(test::device("stewart-6ups"), "joints.tx", 0.02);
  for (const ValidationPoint& point : workspace_points(m))
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Configuration c = stand(m, point.pose_mm_deg).configuration;
      const Vector6 F = 50 * Vector6::Unit(i), other = by_msa(c, F);
      const Vector6 for_fits = analytic::AnalyticModel(c).displaced(F, Geometry::finite).displacement;
      for (const Vector6& one : {by_closed_form(c, F), for_fits})
        EXPECT_LE((one - other).head<3>().norm(), 1e-6 * other.head<3>().norm()) << point.label << " along " << i;
    }
}

// Under moments alone the legs hang by less force, which stiff members round the more. The MSA trembled there until it
// gave up, at 5 of these 27 moments.
TEST(JumpsInShape, LegsThatHangByLittleAreFoundToHang) {
  const Mechanism m = with_play(test::device("stewart-6ups"), "joints.tx", 0.02);
  for (const ValidationPoint& point : workspace_points(m))
    for (Eigen::Index i = 3; i < 6; ++i) {
      const Configuration c = stand(m, point.pose_mm_deg).configuration;
      const Vector6 F = 5 * Vector6::Unit(i), other = by_msa(c, F);
      const Vector6 for_fits = analytic::AnalyticModel(c).displaced(F, Geometry::finite).displacement;
      EXPECT_LE((for_fits - other).tail<3>().norm(), 1e-3 * other.tail<3>().norm()) << point.label << " about " << i;
    }
}

// Under a load that bends an arm some joints are pushed to an end of their play, others hang within it.
TEST(JumpsInShape, PlayInAllJointsOfAnArmStandsWhereBothTheoriesSay) {
  const Mechanism m = with_play(test::device("arm"), "drives.rz", 4e-5);
  for (const ValidationPoint& point : workspace_points(m)) {
    const auto there = stand(m, point.pose_mm_deg);
    Vector6 F;
    F << 0.01, 0.02, -50, 0, 0, 0.01;
    EXPECT_FALSE(analytic::AnalyticModel(there.configuration).solve(F, Geometry::finite).apart) << point.label;
    const SolveResult found = solve(m, there, F, {}, Geometry::finite);
    EXPECT_LE(found.relative_difference, 1e-6 + 10 * found.discretisation) << point.label;
  }
}

struct Play {
  const char* at;
  double gap;  ///< mm or rad
};
struct LoosePlay {
  const char* device;
  std::vector<Play> play;
  std::size_t point;
  Vector6 F;
};

/// Of the MSA, which crept in the first two: play that hardly anything holds went to its end by thirty small steps. In
/// the others rounding moved play that nothing holds at all, round by round.
std::vector<LoosePlay> hardly_held() {
  const auto load = [](std::initializer_list<double> of) { return Vector6(Eigen::Map<const Vector6>(of.begin())); };
  return {
      {"scara", {{"tool.tx", 1.119e-5}, {"elbow.ty", 8.8e-4}, {"wrist.rz", 1.81e-6}}, 5, load({67, -41, 12, 0, 0, 0})},
      {"haptic-6psu-ideal-joints",
       {{"joints.rz", 1.287e-6}, {"joints.ty", 1.258e-5}},
       1,
       load({22, 29, -11, -1.1, -0.56, 1.13})},
      {"hybrid", {{"head.joints.rx", 9.72e-6}, {"brake.rz", 1.7e-7}}, 7, load({0, 0, -50, 0, 0, 0})},
      {"hybrid", {{"head.hinge.rx", 1.442e-6}, {"ends.tz", 1.629e-4}}, 4, load({0, 0, -50, 0, 0, 0})},
  };
}

TEST(JumpsInShape, PlayThatHardlyAnythingHoldsIsFound) {
  for (const LoosePlay& at : hardly_held()) {
    Mechanism m = test::device(at.device);
    for (const Play& play : at.play) m = with_play(m, play.at, play.gap);
    const Configuration c = stand(m, workspace_points(m)[at.point].pose_mm_deg).configuration;
    const Vector6 one = by_closed_form(c, at.F), other = by_msa(c, at.F, 4);
    // Across the load, play that nothing holds may be anywhere.
    const Vector3 along = at.F.head<3>().normalized();
    EXPECT_NEAR(one.head<3>().dot(along), other.head<3>().dot(along), 1e-6 * other.head<3>().norm()) << at.device;
  }
}

class PlayAtRandom : public ::testing::TestWithParam<std::string> {};

// One to three plays at places by lot, from a tenth to ten times as large as their effects start with, under a force
// and a moment by lot. The closed form divides members until it estimates that 1e-6 is left. Rounding: the length of a
// member of 1 m and 1e8 N/m is known to 1e-15 m, its force to 1e-7 N; a leg that hangs by 50 N/m moves by 2e-9 m within
// its play for that, and T, where the leg leans by 1e-3, by 1e-12 of the machine.
TEST_P(PlayAtRandom, StandsWhereBothTheoriesSay) {
  const Mechanism drawn = test::device(GetParam());
  std::vector<effects::Effect> play = effects::place_effects(subject::Subject(drawn), test::all_effects());
  std::erase_if(play, [](const effects::Effect& e) { return !e.name.starts_with("clearance@"); });
  const std::vector<ValidationPoint> points = workspace_points(drawn);
  std::mt19937 random(1);
  for (int trial = 0; trial < 12; ++trial) {
    Mechanism m = drawn;
    std::string what;
    for (int i = 0; i <= trial % 3; ++i) {
      const effects::Effect& e = play[random() % play.size()];
      const auto leg = e.scope == effects::Scope::one_leg ? std::optional(1) : std::nullopt;
      m = effects::with_effect(m, e, std::pow(10, test::uniform(random, -1, 1)) * effects::start_values(e), leg);
      what += e.name + " ";
    }
    const auto there = stand(m, points[random() % points.size()].pose_mm_deg);
    Vector6 F;
    F << test::random_vector(random, 50), test::random_vector(random, 2);
    const Vector6 one = by_closed_form(there.configuration, F), other = by_msa(there.configuration, F);
    const double rounding = 1e-12 * there.configuration.size;
    EXPECT_LE((one - other).head<3>().norm(), 1e-6 * other.head<3>().norm() + rounding) << trial << " " << what;
  }
}

INSTANTIATE_TEST_SUITE_P(Devices, PlayAtRandom,
                         ::testing::Values("arm", "scara", "hybrid", "tripteron", "stewart-6ups", "3-upu"));

// Loaded along y, a slide of the hybrid's head is pushed outwards from the middle of its play, to whichever end: by
// symmetry both are equilibria.
TEST(JumpsInShape, PlayThatStandsAtEitherEndIsNoDisagreement) {
  const Mechanism m =
      effects::with_effect(test::device("hybrid"), test::effect("actuator_backlash"), VectorX::Constant(1, 0.02));
  const auto home = stand(m, workspace_points(m).front().pose_mm_deg);
  const SolveResult found = solve(m, home, 50 * Vector6::Unit(1), {}, Geometry::finite);
  const Vector6 &a = found.solutions[0].displacement_mm_rad, &b = found.solutions[1].displacement_mm_rad;
  EXPECT_NEAR(std::abs(a(0)), std::abs(b(0)), 1e-6);
  EXPECT_NEAR(std::abs(a(4)), std::abs(b(4)), 1e-8);
  EXPECT_GT(std::abs(a(0)), 0.02);
}

}  // namespace
}  // namespace deflect
