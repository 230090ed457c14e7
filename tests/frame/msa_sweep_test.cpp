// The frame solver for sweeps against the one that assembles the whole structure at each pose.
#include "msa/frame/msa_sweep.h"

#include <gtest/gtest.h>

#include "msa/frame/msa.h"
#include "tests/support/allocation_count.h"
#include "tests/support/apart.h"
#include "tests/support/devices.h"
#include "tests/support/mechanisms.h"

namespace deflect::frame {
namespace {

using test::apart;

void expect_the_model(MsaSweep& sweep, const Configuration& c, const MemberDivision& division, const Vector6& F,
                      double bound) {
  ASSERT_TRUE(sweep.solve(c, F));
  MsaModel model(c, division);
  const MsaSolution s = model.solve(F);
  EXPECT_LT(apart(sweep.displacement(), s.displacement, c.size), bound);
  EXPECT_LT(apart(sweep.stiffness(), model.stiffness(s.state).K, c.size), bound);
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
TEST(MsaSweep, JointsAndSpringsAnywhere) {
  Mechanism m = test::device("haptic-6psu");
  m = test::with(m, "leg.actuator.tz", "{law: linear, stiffness: 2000 N/mm}", Edit::Action::append);
  m = test::with(m, "leg.actuator.ry", "{law: linear, stiffness: 5e6 Nmm/rad}", Edit::Action::append);
  m = test::with(m, "leg.carriage.rx", "{law: hardening, stiffness: 4e6 Nmm/rad, reference: 0.01 rad}",
                 Edit::Action::append);
  m = test::with(m, "leg.ball_joint.tz", "{law: power, deflection: 1 um, force: 10 N, exponent: 0.7}",
                 Edit::Action::append);
  m = test::with(m, "leg.mount.tx", "{law: linear, stiffness: 9000 N/mm}", Edit::Action::append);
  m = test::with(m, "leg.ball_joint.preload", "{tz: 20 N}");
  const Configuration c = configure(m, home_pose(m));
  MsaSweep sweep(c);
  ASSERT_TRUE(sweep.applies());
  std::mt19937 random(5);
  for (int i = 0; i < 5; ++i) expect_the_model(sweep, c, {}, test::random_wrench(random), 1e-9);
  EXPECT_GT(sweep.iterations(), 1);
}

TEST(MsaSweep, AllocatesNothingFromPoseToPose) {
  const Mechanism m = test::device("haptic-6psu");
  const std::vector<Pose> poses = test::random_poses(m, 5);
  Posing posing(m);
  const Configuration& first = posing.at(poses[0]);
  MsaSweep sweep(first, equal_division(first, 4));
  const Vector6 F = 50 * Vector6::Unit(1);
  sweep.solve(posing.at(poses[1]), F);
  const std::size_t before = test::allocation_count();
  for (const Pose& pose : poses) ASSERT_TRUE(sweep.solve(posing.at(pose), F));
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
  EXPECT_FALSE(contacts.solve(c, Vector6::Zero())) << "contacts without load have no stiffness";
}

TEST(MsaSweep, LeavesToTheModelMembersSoStiffThatDigitsWouldBeLost) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  Configuration c = configure(m, home_pose(m));
  const Vector6 F = 50 * Vector6::Unit(0);
  MsaSweep sweep(c);
  EXPECT_TRUE(sweep.solve(c, F));
  const auto stiffen = [&](double factor) {
    for_each_part(c.legs, [&](auto& part) {
      if constexpr (requires { part.E; })
        if (part.part == "link") part.E *= factor, part.G *= factor;
    });
  };
  stiffen(100);
  expect_the_model(sweep, c, {}, F, 1e-9);
  stiffen(1e6);
  EXPECT_FALSE(sweep.solve(c, F));
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
  EXPECT_FALSE(five.solve(c, F));
}

}  // namespace
}  // namespace deflect::frame
