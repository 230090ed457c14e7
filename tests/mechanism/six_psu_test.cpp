// Kinematics of the 6-PSU and the configuration made from it.
#include "msa/mechanism/six_psu.h"

#include <gtest/gtest.h>

#include "tests/support/devices.h"

namespace deflect {
namespace {

using test::device;
using test::six_psu;

const Mechanism& haptic() {
  static const Mechanism m = device("haptic-6psu-ideal-joints");
  return m;
}

std::array<double, 6> sliders(const SixPsu& k, const Pose& pose) {
  std::array<double, 6> q{};
  for (std::size_t i = 0; i < 6; ++i) q[i] = leg_at(k, static_cast<int>(i) + 1, pose).slider;
  return q;
}

std::string refusal(const SixPsu& k, int leg, const Pose& pose) {
  try {
    leg_at(k, leg, pose);
  } catch (const ModelError& e) {
    return e.what();
  }
  return "";
}

TEST(SixPsu, CentreOfTheCubeIsWhereTheSlidersStandAt80mm) {
  const Pose centre = centred_pose(six_psu(haptic()), 0.080);
  EXPECT_NEAR(1e3 * centre.p_WT.z(), 173.898547, 0.51e-6);
  for (const double q : sliders(six_psu(haptic()), centre)) EXPECT_NEAR(q, 0.080, 1e-16);
}

TEST(SixPsu, EveryLinkHasItsLengthAndEveryGuidewayIsVertical) {
  for (const Pose& pose : test::random_poses(haptic(), 50))
    for (int leg = 1; leg <= 6; ++leg) {
      const SixPsuLeg g = leg_at(six_psu(haptic()), leg, pose);
      EXPECT_NEAR((g.p_WC - g.p_WB).norm(), 0.1255, 1e-16);
      EXPECT_LT(g.p_WB.z(), g.p_WC.z());
      EXPECT_EQ((g.p_WB - g.p_WA).head<2>().norm(), 0);
      EXPECT_NEAR(g.p_WA.norm(), 0.118, 1e-16);
      EXPECT_NEAR((g.p_WC - pose.p_WT).norm(), 0.055, 1e-16);
    }
}

TEST(SixPsu, LegsStandInPairsThatAThirdOfATurnPermutes) {
  const Matrix3 third = rotation_from_rpy(0, 0, 2 * pi / 3);
  for (const Pose& pose : test::random_poses(haptic(), 10)) {
    const Pose turned{third * pose.p_WT, third * pose.R_WT * third.transpose()};
    for (int leg = 1; leg <= 6; ++leg) {
      const SixPsuLeg a = leg_at(six_psu(haptic()), leg, pose),
                      b = leg_at(six_psu(haptic()), (leg + 1) % 6 + 1, turned);
      EXPECT_LE((third * a.p_WC - b.p_WC).norm(), 1e-15);
      EXPECT_NEAR(a.slider, b.slider, 1e-15);
    }
  }
  const SixPsuLeg one = leg_at(six_psu(haptic()), 1, test::home(haptic()));
  EXPECT_NEAR(std::atan2(one.p_WA.y(), one.p_WA.x()), 12.5 * pi / 180, 1e-15);  // + beta/2
  EXPECT_NEAR(std::atan2(one.p_WC.y(), one.p_WC.x()), 52.0 * pi / 180, 1e-15);  // 60° − alpha/2
}

TEST(SixPsu, ForwardKinematicsComesBackToThePose) {
  const Pose start = test::home(haptic());
  for (const Pose& pose : test::random_poses(haptic(), 200)) {
    const ForwardKinematics f = forward_kinematics(six_psu(haptic()), sliders(six_psu(haptic()), pose), start);
    ASSERT_TRUE(f.converged);
    EXPECT_LE((f.pose.p_WT - pose.p_WT).norm(), 1e-14);
    EXPECT_LE((f.pose.R_WT - pose.R_WT).norm(), 1e-13);
    EXPECT_LE(f.iterations, 10);
  }
}

TEST(SixPsu, ForwardKinematicsSaysWhenThereIsNoAssembly) {
  const ForwardKinematics f =
      forward_kinematics(six_psu(haptic()), {0.02, 0.5, 0.02, 0.5, 0.02, 0.5}, test::home(haptic()));
  EXPECT_FALSE(f.converged);
}

TEST(SixPsu, RefusesByLegAndLimit) {
  Pose pose = test::home(haptic());
  pose.p_WT.x() += 0.1;
  EXPECT_NE(refusal(six_psu(haptic()), 3, pose).find("leg 3: the link does not reach: its platform joint is"),
            std::string::npos);
  pose = test::home(haptic());
  pose.p_WT.z() += 0.15;
  EXPECT_NE(
      refusal(six_psu(haptic()), 2, pose).find("leg 2: the slider would stand at 230 mm, outside its range of 10 to"),
      std::string::npos);
  EXPECT_THROW(configure(haptic(), pose), ModelError);
  Mechanism wide = haptic();
  std::get<SixPsu>(wide.kinematics).base_radius = 0.4;
  EXPECT_THROW(centred_pose(six_psu(wide), 0.08), ModelError);
}

/// A pose that puts the platform joint of leg 1 exactly above its base joint.
Pose with_vertical_link_1(const SixPsu& k) {
  Pose pose;
  pose.p_WT = Vector3(0, 0, 0.2);
  const SixPsuLeg centred = leg_at(k, 1, pose);
  Vector3 shift = centred.p_WA - centred.p_WC;
  shift.z() = 0;
  pose.p_WT += shift;
  return pose;
}

TEST(Configuration, AVerticalLinkHasAxes) {
  Mechanism m = haptic();
  SixPsu& k = std::get<SixPsu>(m.kinematics);
  k.link_length = 0.16;  // long enough that the other five links reach
  const Pose pose = with_vertical_link_1(k);
  const Configuration c = configure(m, pose);
  for (const PlacedPart& part : c.legs[0].parts)
    if (const auto* member = std::get_if<PlacedMember>(&part)) {
      EXPECT_LE((member->R_WM.transpose() * member->R_WM - Matrix3::Identity()).norm(), 1e-15);
      EXPECT_NEAR(member->R_WM.col(0).z(), 1, 1e-15);
      EXPECT_NEAR(member->R_WM.determinant(), 1, 1e-15);
    }
}

TEST(Configuration, PartsComeInTheOrderOfTheFileWithAxesAlongTheLink) {
  const Configuration c = configure(haptic(), test::home(haptic()));
  ASSERT_EQ(c.legs.size(), 6u);
  for (const PlacedLeg& leg : c.legs) {
    const auto& link = std::get<PlacedMember>(leg.parts[4]);
    const auto& universal = std::get<PlacedJoint>(leg.parts[5]);
    EXPECT_EQ(link.part, "link");
    EXPECT_EQ(universal.part, "universal_joint");
    EXPECT_LE((universal.R_WJ.col(2) - (link.p_W_end - link.p_W_start).normalized()).norm(), 1e-15);
    EXPECT_TRUE(universal.free(3) && universal.free(4) && !universal.free(5));
    EXPECT_NEAR(universal.R_WJ.determinant(), 1, 1e-15);
    EXPECT_NEAR(c.actuators[static_cast<std::size_t>(&leg - c.legs.data())].value, 0.080, 1e-16);
  }
}

TEST(Configuration, AVariationChangesItsLegAlone) {
  const Mechanism m = test::with(haptic(), "leg[4].guideway.bending_factor", "0.5");
  const Configuration c = configure(m, test::home(m));
  for (std::size_t leg = 0; leg < 6; ++leg) {
    const SectionProperties& s = std::get<PlacedMember>(c.legs[leg].parts[1]).section;
    EXPECT_NEAR(s.Iy, (leg == 3 ? 0.5 : 1) * pi * std::pow(0.008, 4) / 64, 1e-24);
    EXPECT_NEAR(s.A, pi * 0.004 * 0.004, 1e-19);
  }
}

}  // namespace
}  // namespace deflect
