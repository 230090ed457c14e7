// The frame solver for sweeps against the one that assembles the whole structure at each pose.
#include "msa/frame/mechanism/msa_sweep.h"

#include <gtest/gtest.h>

#include "msa/frame/mechanism/msa.h"
#include "tests/support/allocation_count.h"
#include "tests/support/apart.h"
#include "tests/support/devices.h"
#include "tests/support/mechanisms.h"

namespace deflect::frame {
namespace {

using test::apart;

void expect_the_model(MsaSweep& sweep, const Configuration& c, const MemberDivision& division, const Vector6& F,
                      double bound) {
  sweep.at(c);
  ASSERT_TRUE(sweep.solve(F));
  MsaModel model(c, division);
  const MsaSolution s = model.solve(F);
  EXPECT_LT(apart(sweep.displacement(), s.displacement, c.size), bound);
  EXPECT_LT(apart(sweep.stiffness(), model.stiffness(s.state).K, c.size), bound);
  double energy = 0;
  for (const auto& [part, of_part] : s.energies) energy += of_part;
  EXPECT_NEAR(sweep.energy(), energy, bound * energy);
}

class SweptFrame : public ::testing::TestWithParam<std::tuple<const char*, int>> {};

TEST_P(SweptFrame, EqualsTheModelAtEachPose) {
  const auto [name, elements] = GetParam();
  const Mechanism m = test::device(name);
  const MemberDivision division = equal_division(configure(m, home_pose(m)), elements);
  Posing posing(m);
  MsaSweep sweep(posing.at(home_pose(m)), division);
  ASSERT_TRUE(sweep.applies());
  std::mt19937 random(3);
  for (int i = 0; i < 10; ++i) {
    Pose pose = home_pose(m);
    pose.p_WT += test::random_vector(random, 0.01);
    expect_the_model(sweep, posing.at(pose), division, test::random_wrench(random), 1e-9);
  }
}
INSTANTIATE_TEST_SUITE_P(Devices, SweptFrame,
                         ::testing::Combine(::testing::Values("haptic-6psu", "haptic-6psu-ideal-joints", "tripteron",
                                                              "stewart-6ups"),
                                            ::testing::Values(1, 4)));

// Joints before the first member, springs among them, laws in series, preload, moments in joints.
Mechanism with_springs_anywhere() {
  Mechanism m = test::device("haptic-6psu");
  m = test::with(m, "leg.actuator.tz", "{law: linear, stiffness: 2000 N/mm}", Edit::Action::append);
  m = test::with(m, "leg.actuator.ry", "{law: linear, stiffness: 5e6 Nmm/rad}", Edit::Action::append);
  m = test::with(m, "leg.actuator.rx", "{law: hardening, stiffness: 6e6 Nmm/rad, reference: 0.01 rad}",
                 Edit::Action::append);
  m = test::with(m, "leg.carriage.rx", "{law: hardening, stiffness: 4e6 Nmm/rad, reference: 0.01 rad}",
                 Edit::Action::append);
  m = test::with(m, "leg.ball_joint.tz", "{law: power, deflection: 1 um, force: 10 N, exponent: 0.7}",
                 Edit::Action::append);
  m = test::with(m, "leg.mount.tx", "{law: linear, stiffness: 9000 N/mm}", Edit::Action::append);
  return test::with(m, "leg.ball_joint.preload", "{tz: 20 N}");
}

TEST(MsaSweep, JointsAndSpringsAnywhere) {
  const Mechanism m = with_springs_anywhere();
  const Configuration c = configure(m, home_pose(m));
  MsaSweep sweep(c);
  ASSERT_TRUE(sweep.applies());
  std::mt19937 random(5);
  for (int i = 0; i < 5; ++i) expect_the_model(sweep, c, {}, test::random_wrench(random), 1e-9);
  EXPECT_GT(sweep.iterations(), 1);
}

/// Everything that a solve leaves, in one column.
VectorX result(const MsaSweep& sweep, std::size_t legs) {
  VectorX out(49 + 36 * static_cast<Eigen::Index>(legs));
  out << sweep.displacement(), sweep.stiffness().reshaped(), sweep.reaction(), sweep.energy(),
      VectorX::Zero(36 * static_cast<Eigen::Index>(legs));
  for (std::size_t l = 0; l < legs; ++l)
    out.segment<36>(49 + 36 * static_cast<Eigen::Index>(l)) = sweep.leg_stiffness(l).reshaped();
  return out;
}

TEST(MsaSweep, LoadsAtOnePoseKnowNothingOfEachOther) {
  std::mt19937 random(7);
  std::vector<Vector6> loads;
  for (int i = 0; i < 4; ++i) loads.push_back(test::random_wrench(random));
  for (const Mechanism& m :
       {with_springs_anywhere(), test::device("haptic-6psu"), test::device("haptic-6psu-ideal-joints")}) {
    const Configuration c = configure(m, home_pose(m));
    std::vector<VectorX> alone;
    for (const Vector6& F : loads) {
      MsaSweep sweep(c);
      sweep.at(c);
      ASSERT_TRUE(sweep.solve(F));
      alone.push_back(result(sweep, c.legs.size()));
    }
    MsaSweep sweep(c);
    sweep.at(c);
    for (const std::size_t i : {3, 0, 2, 1, 0}) {
      ASSERT_TRUE(sweep.solve(loads[i]));
      EXPECT_EQ(result(sweep, c.legs.size()), alone[i]);
    }
  }
}

// Links are known by their length, which has its own rounding at each pose.
TEST(MsaSweep, ComesBackToAPose) {
  const Mechanism m = with_springs_anywhere();
  const std::vector<Pose> poses = test::random_poses(m, 6);
  const Vector6 F = 50 * Vector6::Unit(1);
  Posing posing(m);
  MsaSweep sweep(posing.at(poses[0]), equal_division(posing.at(poses[0]), 3));
  std::vector<VectorX> first;
  for (int round = 0; round < 2; ++round)
    for (std::size_t i = 0; i < poses.size(); ++i) {
      sweep.at(posing.at(poses[i]));
      ASSERT_TRUE(sweep.solve(F));
      const VectorX now = result(sweep, 6);
      if (round == 0)
        first.push_back(now);
      else
        EXPECT_LT((now - first[i]).norm(), 1e-12 * now.norm()) << i;
    }
}

TEST(MsaSweep, ElementsOfAMemberChangeNothing) {
  const Mechanism m = with_springs_anywhere();
  const std::vector<Pose> poses = test::random_poses(m, 5);
  Posing posing(m);
  const Configuration& first = posing.at(poses[0]);
  MsaSweep one(first), four(first, equal_division(first, 4));
  std::mt19937 random(11);
  for (const Pose& pose : poses) {
    const Configuration& c = posing.at(pose);
    const Vector6 F = test::random_wrench(random);
    one.at(c);
    four.at(c);
    ASSERT_TRUE(one.solve(F));
    ASSERT_TRUE(four.solve(F));
    EXPECT_LT(apart(four.displacement(), one.displacement(), c.size), 1e-10);
    EXPECT_LT(apart(four.stiffness(), one.stiffness(), c.size), 1e-10);
    EXPECT_LT(apart(four.reaction(), one.reaction(), 1 / c.size), 1e-10);
    EXPECT_NEAR(four.energy(), one.energy(), 1e-10 * one.energy());
  }
}

// A rod that stands on a spring and ends in another, bent by the force P and the moment M at its end: the springs turn
// by φ₁(M + PL) and φ₂(M) and the foot slides on a linear one, δ = P/k + φ₁L + PL³/3EI + ML²/2EI,
// θ = φ₁ + φ₂ + PL²/2EI + ML/EI.
TEST(MsaSweep, ARodBetweenTwoSprings) {
  const double L = 0.2, P = 30, M = 2, k = 4e5;
  const auto power = [](const std::string& part, double z, const PowerLaw& law) {
    PlacedJoint j = test::joint(part, {0, 0, z}, "rrrrrr");
    j.laws[4].emplace_back(law);
    return j;
  };
  const auto turn = [](const PowerLaw& law, double m) {
    return law.deflection * std::pow(m / law.force, law.exponent);
  };
  const auto yield = [&](const PowerLaw& law, double m) { return law.exponent * turn(law, m) / m; };
  const PowerLaw foot{1e-3, 4, 0.6}, head{2e-3, 3, 0.8};
  const PlacedMember rod = test::rod("rod", {0, 0, 0}, {0, 0, L}, 0.01);
  PlacedJoint sliding = power("foot", 0, foot);
  sliding.laws[0].emplace_back(LinearLaw{k});
  const Configuration c = test::configuration({0, 0, L}, {{"leg", {sliding, rod, power("head", L, head)}}}, L);
  MsaSweep sweep(c);
  ASSERT_TRUE(sweep.applies());
  sweep.at(c);
  ASSERT_TRUE(sweep.solve((Vector6() << P, 0, 0, 0, M, 0).finished()));
  const double EI = rod.E * rod.section.Iy, at_foot = M + P * L;
  const double delta = P / k + turn(foot, at_foot) * L + P * L * L * L / (3 * EI) + M * L * L / (2 * EI);
  const double theta = turn(foot, at_foot) + turn(head, M) + P * L * L / (2 * EI) + M * L / EI;
  EXPECT_NEAR(sweep.displacement()(0), delta, 1e-12 * delta);
  EXPECT_NEAR(sweep.displacement()(4), theta, 1e-12 * theta);
  Eigen::Matrix2d C;
  C << 1 / k + yield(foot, at_foot) * L * L + L * L * L / (3 * EI), yield(foot, at_foot) * L + L * L / (2 * EI), 0,
      yield(foot, at_foot) + yield(head, M) + L / EI;
  C(1, 0) = C(0, 1);
  const Eigen::Matrix2d K = C.inverse();
  EXPECT_NEAR(sweep.stiffness()(0, 0), K(0, 0), 1e-11 * K(0, 0));
  EXPECT_NEAR(sweep.stiffness()(0, 4), K(0, 1), 1e-11 * std::abs(K(0, 1)));
  EXPECT_NEAR(sweep.stiffness()(4, 4), K(1, 1), 1e-11 * K(1, 1));
  // Of a power law φ ~ mᵉ the energy is ∫m dφ = m φ e/(1 + e).
  const double of_springs = at_foot * turn(foot, at_foot) * foot.exponent / (1 + foot.exponent) +
                            M * turn(head, M) * head.exponent / (1 + head.exponent);
  const double of_rod = (P * P * L * L * L / 3 + P * M * L * L + M * M * L) / (2 * EI);
  const double energy = P * P / (2 * k) + of_springs + of_rod;
  EXPECT_NEAR(sweep.energy(), energy, 1e-11 * energy);
  EXPECT_LT(apart(sweep.reaction(), (Vector6() << -P, 0, 0, 0, -M, 0).finished(), 1 / L), 1e-11);
}

TEST(MsaSweep, AllocatesNothingFromPoseToPose) {
  const Mechanism m = with_springs_anywhere();
  const std::vector<Pose> poses = test::random_poses(m, 5);
  Posing posing(m);
  const Configuration& first = posing.at(poses[0]);
  MsaSweep sweep(first, equal_division(first, 4));
  const Vector6 F = 50 * Vector6::Unit(1);
  sweep.at(posing.at(poses[1]));
  sweep.solve(F);
  const std::size_t before = test::allocation_count();
  for (const Pose& pose : poses) {
    sweep.at(posing.at(pose));
    ASSERT_TRUE(sweep.solve(F));
    ASSERT_TRUE(sweep.solve(-2 * F));
  }
  EXPECT_EQ(test::allocation_count(), before);
}

TEST(MsaSweep, LeavesToTheModelWhatItDoesNotKnow) {
  for (const char* name : {"delta", "hybrid", "fanuc-r2000ic"}) {
    const Mechanism m = test::device(name);
    EXPECT_FALSE(MsaSweep(configure(m, home_pose(m))).applies()) << name;
  }
  const Mechanism m = test::device("haptic-6psu");
  const Configuration c = configure(m, home_pose(m));
  MsaSweep contacts(c);
  EXPECT_FALSE(contacts.solve(50 * Vector6::Unit(0))) << "nowhere yet";
}

// By hand: each leg of the device carries along its link alone, through two contacts in series. The load that comes
// next is solved as if it were the first.
TEST(MsaSweep, ContactsWithoutLoadHaveNoStiffness) {
  const Mechanism m = test::device("haptic-6psu");
  const Configuration c = configure(m, home_pose(m));
  MsaSweep contacts(c);
  contacts.at(c);
  ASSERT_TRUE(contacts.solve(Vector6::Zero()));
  EXPECT_EQ(contacts.stiffness(), Matrix6(Matrix6::Zero()));
  EXPECT_EQ(contacts.displacement(), Vector6(Vector6::Zero()));
  EXPECT_EQ(contacts.energy(), 0);
  EXPECT_EQ(contacts.reaction(), Vector6(Vector6::Zero()));
  for (std::size_t i = 0; i < c.legs.size(); ++i) EXPECT_EQ(contacts.leg_stiffness(i), Matrix6(Matrix6::Zero()));
  expect_the_model(contacts, c, {}, 50 * Vector6::Unit(0), 1e-9);
}

// The second contact along a link does not move where the first one yields to everything: nothing is stored or carried.
TEST(MsaSweep, TwoContactsInALineWithoutLoadStandStill) {
  const Mechanism m = test::with(test::device("haptic-6psu"), "leg.universal_joint.tz",
                                 "{law: power, deflection: 1 um, force: 10 N, exponent: 0.6667}", Edit::Action::append);
  const Configuration c = configure(m, home_pose(m));
  MsaSweep contacts(c);
  contacts.at(c);
  ASSERT_TRUE(contacts.solve(Vector6::Zero()));
  EXPECT_EQ(contacts.energy(), 0);
  EXPECT_EQ(contacts.reaction(), Vector6(Vector6::Zero()));
  EXPECT_EQ(contacts.stiffness(), Matrix6(Matrix6::Zero()));
  expect_the_model(contacts, c, {}, 50 * Vector6::Unit(0), 1e-9);
}

TEST(MsaSweep, LeavesToTheModelMembersSoStiffThatDigitsWouldBeLost) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  Configuration c = configure(m, home_pose(m));
  const Vector6 F = 50 * Vector6::Unit(0);
  MsaSweep sweep(c);
  expect_the_model(sweep, c, {}, F, 1e-9);
  const auto stiffen = [&](double factor) {
    for_each_part(c.legs, [&](auto& part) {
      if constexpr (requires { part.E; })
        if (part.part == "link") part.E *= factor, part.G *= factor;
    });
  };
  stiffen(100);
  expect_the_model(sweep, c, {}, F, 1e-9);
  stiffen(1e6);
  sweep.at(c);
  EXPECT_FALSE(sweep.solve(F));
}

// Five bars on ball joints leave the platform one motion.
TEST(MsaSweep, RefusesWhatNothingHolds) {
  std::mt19937 random(1);
  std::vector<PlacedLeg> legs;
  for (const auto& [foot, head] : test::hexapod(random)) {
    const Matrix3 R = test::z_along(head - foot);
    legs.push_back({"bar",
                    {test::joint("foot", foot, "rrrfff", R), test::rod("rod", foot, head, 0.01),
                     test::joint("head", head, "rrrffr", R)}});
  }
  const Vector6 F = 10 * Vector6::Unit(2);
  Configuration c = test::configuration({0, 0, 0.4}, legs, 0.5);
  MsaSweep six(c);
  ASSERT_TRUE(six.applies());
  expect_the_model(six, c, {}, F, 1e-9);
  c.legs.pop_back();
  MsaSweep five(c);
  five.at(c);
  EXPECT_FALSE(five.solve(F));
}

}  // namespace
}  // namespace deflect::frame
