// A device moved from pose to pose is the device placed there anew.
#include <gtest/gtest.h>

#include "msa/base/error.h"
#include "tests/support/devices.h"

namespace deflect {
namespace {

bool same(const PlacedJoint& a, const PlacedJoint& b) {
  bool cables = true;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t n = 0; n < a.laws[i].size(); ++n)
      if (const auto* cable = std::get_if<CableLaw>(&a.laws[i][n]))
        cables = cables && cable->length == std::get<CableLaw>(b.laws[i][n]).length;
  return a.part == b.part && a.p_W == b.p_W && a.R_WJ == b.R_WJ && cables;
}

bool same(const PlacedMember& a, const PlacedMember& b) {
  return a.part == b.part && a.p_W_start == b.p_W_start && a.p_W_end == b.p_W_end && a.R_WM == b.R_WM &&
         a.section.Iy == b.section.Iy;
}

void expect_same(const Configuration& a, const Configuration& b) {
  ASSERT_EQ(a.legs.size(), b.legs.size());
  EXPECT_EQ(a.size, b.size);
  EXPECT_TRUE(same(a.tool, b.tool));
  EXPECT_TRUE(same(a.base, b.base));
  for (std::size_t l = 0; l < a.legs.size(); ++l) {
    EXPECT_EQ(a.legs[l].name, b.legs[l].name);
    EXPECT_EQ(a.legs[l].misfit, b.legs[l].misfit);
    ASSERT_EQ(a.legs[l].parts.size(), b.legs[l].parts.size());
    for (std::size_t p = 0; p < a.legs[l].parts.size(); ++p) {
      if (const auto* joint = std::get_if<PlacedJoint>(&a.legs[l].parts[p])) {
        ASSERT_TRUE(same(*joint, std::get<PlacedJoint>(b.legs[l].parts[p]))) << l << " " << p;
      } else if (const auto* member = std::get_if<PlacedMember>(&a.legs[l].parts[p])) {
        ASSERT_TRUE(same(*member, std::get<PlacedMember>(b.legs[l].parts[p]))) << l << " " << p;
      }
    }
  }
  ASSERT_EQ(a.actuators.size(), b.actuators.size());
  for (std::size_t i = 0; i < a.actuators.size(); ++i) EXPECT_EQ(a.actuators[i].value, b.actuators[i].value);
}

TEST(Posing, IsConfigureBitByBit) {
  Mechanism m = test::device("haptic-6psu");
  m = test::with(m, "leg.actuator.tz", "{law: cable, material: steel, area: 2 mm^2}", Edit::Action::append);
  m = test::with(m, "leg[3].link", "{member: link_rod, material: steel, from: B, to: C, bending_factor: 0.9}");
  m.misfits = {{2, {{1e-5, 0, 0}, {0, 1e-4, 0}}, {{0, 0, 2e-5}, Vector3::Zero()}}};
  Posing posing(m);
  for (const Pose& pose : test::random_poses(m, 5)) expect_same(posing.at(pose), configure(m, pose));
}

TEST(Posing, AnyFamilyMoves) {
  const Mechanism m = test::device("stewart-6ups");
  Posing posing(m);
  for (const double z : {0.0, 0.005}) {
    Pose pose = home_pose(m);
    pose.p_WT.z() += z;
    expect_same(posing.at(pose), configure(m, pose));
  }
}

TEST(Posing, RefusesWhatConfigureRefusesAndGoesOn) {
  const Mechanism m = test::device("haptic-6psu");
  const std::vector<Pose> poses = test::random_poses(m, 2);
  Posing posing(m);
  posing.at(poses[0]);
  Pose far = poses[0];
  far.p_WT.x() += 1;
  const auto words = [](const auto& attempt) -> std::string {
    try {
      attempt();
    } catch (const ModelError& e) {
      return e.what();
    }
    return "";
  };
  const std::string refused = words([&] { configure(m, far); });
  EXPECT_NE(refused, "");
  EXPECT_EQ(words([&] { posing.at(far); }), refused);
  expect_same(posing.at(poses[1]), configure(m, poses[1]));
}

/// Joint states of another mechanism are taken where its kinematics are the same, and only there.
TEST(KnownKinematics, GiveTheSameToTheLastBit) {
  for (const char* name : {"delta", "stewart-6ups", "scara"}) {
    const Mechanism m = test::device(name);
    Pose pose = home_pose(m);
    pose.p_WT += Vector3(3e-3, -2e-3, 1e-3);
    const Configuration known = configure(m, pose);
    VectorX q(std::ssize(known.actuators));
    for (std::size_t i = 0; i < known.actuators.size(); ++i) q(static_cast<Eigen::Index>(i)) = known.actuators[i].value;
    const Configuration known_by_joints = configure_joints(m, q);
    const Mechanism softer = test::with(m, "materials.*.E", "0.5", Edit::Action::multiply);
    expect_same(configure(softer, pose, &known), configure(softer, pose));
    expect_same(configure_joints(softer, q, &known_by_joints), configure_joints(softer, q));
    Pose other = pose;  // another pose, or coordinates for a pose
    other.p_WT.x() += 1e-3;
    expect_same(configure(m, other, &known), configure(m, other));
    expect_same(configure_joints(m, q, &known), configure_joints(m, q));
  }
  const Mechanism delta = test::device("delta"), longer = test::with(delta, "leg.arm.along", "[525 mm, 0 mm, 0 mm]");
  const Pose home = home_pose(delta);
  const Configuration known = configure(delta, home);
  expect_same(configure(longer, home, &known), configure(longer, home));
  EXPECT_NE(configure(longer, home, &known).actuators[0].value, known.actuators[0].value);
}

TEST(KnownKinematics, AreNoWayAroundTheNumberOfCoordinates) {
  const Mechanism m = test::device("delta");
  const Configuration known = configure(m, home_pose(m));
  EXPECT_THROW(configure_joints(m, VectorX::Zero(2), &known), InputError);
  EXPECT_THROW(configure_joints(m, VectorX::Zero(4)), InputError);
}

}  // namespace
}  // namespace deflect
