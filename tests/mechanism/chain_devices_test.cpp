// Kinematics of the built-in chains against closed forms that are derived here.
#include <gtest/gtest.h>

#include <cmath>

#include "msa/base/error.h"
#include "tests/support/chains.h"

namespace deflect {
namespace {

using test::device;

class EveryChain : public ::testing::TestWithParam<const char*> {};

// Newton ends at rounding: 1e-15 of the size, magnified by the condition of the loops (at most some hundreds here).
TEST_P(EveryChain, ForwardKinematicsUndoInverseKinematics) {
  const Mechanism m = device(GetParam());
  const std::vector<Pose> poses = test::workspace_poses(m, 200);
  ASSERT_EQ(poses.size(), 200u);
  for (const Pose& pose : poses) {
    const Configuration there = configure(m, pose);
    EXPECT_EQ(test::distance(there.pose, pose), 0);
    const Configuration back = configure_joints(m, test::coordinates(there));
    EXPECT_LE(test::distance(back.pose, pose), 1e-11 * (1 + there.size));
    EXPECT_LE((test::coordinates(back) - test::coordinates(there)).norm(), 1e-14);
  }
}

TEST_P(EveryChain, HomeIsWhereItsCoordinatesAre) {
  const Mechanism m = device(GetParam());
  const std::vector<Actuator> home = actuators_of(m);
  const Configuration c = configure(m, home_pose(m));
  ASSERT_EQ(c.actuators.size(), home.size());
  for (std::size_t i = 0; i < home.size(); ++i) {
    EXPECT_NEAR(c.actuators[i].value, home[i].value, 1e-11) << home[i].name;
    EXPECT_EQ(c.actuators[i].name, home[i].name);
  }
}

INSTANTIATE_TEST_SUITE_P(Devices, EveryChain,
                         ::testing::Values("stewart-6ups", "delta", "hybrid", "tripteron", "fanuc-r2000ic"),
                         [](const auto& p) {
                           std::string name = p.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// A strut reaches from its base joint to its platform joint: cylinder and slide together are |C − A|.
TEST(Stewart, SlidesAreTheClosedFormLengths) {
  const Mechanism m = device("stewart-6ups");
  const double cylinder = std::get<Member>(*find(m.leg, "cylinder")).along->z();
  for (const Pose& pose : test::workspace_poses(m, 200, 0.2)) {
    const Configuration c = configure(m, pose);
    for (std::size_t leg = 0; leg < 6; ++leg) {
      const Vector3 A = m.mounts[leg].base.shift, C = pose.p_WT + pose.R_WT * m.mounts[leg].platform.shift;
      EXPECT_NEAR(cylinder + c.actuators[leg].value, (C - A).norm(), 1e-13 * c.size);
    }
  }
}

// In the plane of a motor: knee (w + L cos θ, 0, −L sin θ), ankle (x + u, y, z), l apart: E cos θ + F sin θ = G.
double motor_angle(const Vector3& p, double direction) {
  const double w = 0.567 / (2 * std::sqrt(3.0)), u = 0.076 / std::sqrt(3.0), L = 0.524, l = 1.244;
  const double c = std::cos(direction), s = std::sin(direction);
  const double a = c * p.x() + s * p.y() + u - w, y = -s * p.x() + c * p.y();
  const double E = 2 * a * L, F = -2 * p.z() * L, G = a * a + y * y + p.z() * p.z() + L * L - l * l;
  return std::atan2(F, E) - std::acos(G / std::hypot(E, F));  // the knee outside
}

constexpr double delta_directions[] = {-pi / 2, pi / 6, 5 * pi / 6};

TEST(Delta, MotorsStandAsTheClosedFormSays) {
  const Mechanism m = device("delta");
  for (const Pose& pose : test::workspace_poses(m, 200)) {
    const Configuration c = configure(m, pose);
    ASSERT_EQ(c.actuators.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(c.actuators[i].value, motor_angle(pose.p_WT, delta_directions[i]), 1e-6);  // mounts to 1e-6 mm
  }
}

// Williams' examples, with the decimals of github.com/…/Deltarobot_Kinematics, which computes them: deg, mm.
TEST(Delta, PublishedExamples) {
  const Mechanism m = device("delta");
  const struct {
    Vector3 theta, p;
  } examples[] = {{{0, 0, 0}, {0, 0, -1064.45}},
                  {{10, 20, 30}, {108.14, -180.35, -1243.54}},
                  {{-20.5, -20.5, -20.5}, {0, 0, -900.32}},
                  {{47.5, -11.6, 21.4}, {300.46, 499.94, -1099.83}}};
  for (const auto& [theta, p] : examples) {
    const Configuration c = configure_joints(m, theta * pi / 180);
    EXPECT_LE((1e3 * c.pose.p_WT - p).cwiseAbs().maxCoeff(), 0.0051) << theta.transpose();
    EXPECT_LE((c.pose.R_WT - Matrix3::Identity()).norm(), 1e-9);  // three parallelograms keep the platform's turn
  }
}

TEST(Delta, TiltedPlatformIsRefused) {
  Pose tilted = home_pose(device("delta"));
  tilted.R_WT = rotation_from_rpy(0.02, 0, 0);
  try {
    configure(device("delta"), tilted);
    FAIL();
  } catch (const ModelError& e) {
    EXPECT_NE(std::string(e.what()).find("does not take this pose"), std::string::npos) << e.what();
  }
}

// The elbow of two links of length l from the shoulder at the origin: D = (x² + y² − 2 l²)/(2 l²).
TEST(Tripteron, ElbowsStandAsTheClosedFormSays) {
  const Mechanism m = device("tripteron");
  const double l = 0.75;
  const Matrix3 axes[] = {rotation_from_rpy(0, pi / 2, 0) * rotation_from_rpy(0, 0, pi),
                          rotation_from_rpy(-pi / 2, 0, 0), Matrix3::Identity()};
  const Vector3 origins[] = {{0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
  for (const Pose& pose : test::workspace_poses(m, 200)) {
    const Configuration c = configure(m, pose);
    for (std::size_t leg = 0; leg < 3; ++leg) {
      const Vector3 p = axes[leg].transpose() * (pose.p_WT - origins[leg]);
      EXPECT_NEAR(c.actuators[leg].value, p.z(), 1e-12);
      const double D = (p.x() * p.x() + p.y() * p.y() - 2 * l * l) / (2 * l * l);
      const double q2 = std::atan2(std::sqrt(1 - D * D), D);
      const double q1 = std::atan2(p.y(), p.x()) - std::atan2(l * std::sin(q2), l + l * std::cos(q2));
      const Vector3 elbow = origins[leg] + axes[leg] * Vector3(l * std::cos(q1), l * std::sin(q1), p.z());
      const auto& lower = std::get<PlacedMember>(c.legs[leg].parts.at(4));
      EXPECT_LE((lower.p_W_start - elbow).norm(), 1e-12);
      EXPECT_LE((lower.p_W_end - pose.p_WT).norm(), 1e-12);
    }
  }
}

// Rows [α, a, θ, d] of the published table, as homogeneous matrices; controller angles to those of the table.
Pose fanuc(const Vector6& q) {
  const double rows[6][4] = {{0, 0, 0, 0.670},  {-pi / 2, 0.312, -pi / 2, 0},
                             {0, 1.075, 0, 0},  {-pi / 2, 0.225, 0, 1.280},
                             {pi / 2, 0, 0, 0}, {-pi / 2, 0, 0, 0.215}};
  const double angles[6] = {q(0), q(1), -(q(1) + q(2)), -q(3), -q(4), -q(5)};
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  for (int i = 0; i < 6; ++i) {
    const double ca = std::cos(rows[i][0]), sa = std::sin(rows[i][0]), a = rows[i][1], d = rows[i][3];
    const double c = std::cos(angles[i] + rows[i][2]), s = std::sin(angles[i] + rows[i][2]);
    Eigen::Matrix4d A;
    A << c, -s, 0, a, s * ca, c * ca, -sa, -sa * d, s * sa, c * sa, ca, ca * d, 0, 0, 0, 1;
    T = T * A;
  }
  const Eigen::Vector4d tip = T * Eigen::Vector4d(0.0069, 0.2453, 0.3193, 1);
  return {tip.head<3>(), T.topLeftCorner<3, 3>()};
}

TEST(Fanuc, StandsWhereItsTableSays) {
  const Mechanism m = device("fanuc-r2000ic");
  std::mt19937 random(5);
  for (int i = 0; i < 200; ++i) {
    Vector6 q;
    q << test::random_vector(random, 3), test::random_vector(random, 3);
    EXPECT_LE(test::distance(configure_joints(m, q).pose, fanuc(q)), 1e-13);
  }
}

/// An arm like the PUMA 560 by rows of either table. Modified row i has α, a of the standard row before it; the last
/// standard row's a and α stand behind the last joint.
std::string puma(const char* table) {
  const double alpha[] = {90, 0, -90, 90, -90, 0}, a[] = {0, 431.8, 20.3, 0, 0, 30},
               d[] = {671.8, 0, 150, 431.8, 0, 56}, theta[] = {10, -20, 30, 5, 15, -25};
  std::string leg = "name: arm\nkinematics: {family: chains}\nleg:\n";
  for (std::size_t i = 0; i < 6; ++i) {
    const bool standard = std::string(table) == "dh";
    const std::size_t before = i - 1;
    const double twist = standard ? alpha[i]
                         : i > 0  ? alpha[before]
                                  : 0,
                 length = standard ? a[i]
                          : i > 0  ? a[before]
                                   : 0;
    const std::string row =
        fmt::format("theta: {} deg, d: {} mm, a: {} mm, alpha: {} deg", theta[i], d[i], length, twist);
    const std::string law = "rz: {law: linear, stiffness: 1e7 Nmm/rad}";
    if (std::string(table) == "offsets")  // the rows as rigid pieces behind joints about z
      leg += fmt::format(
          "  j{0}: {{joint: motor, home: {{rz: 20 deg}}, {1}}}\n  t{0}: {{offset: [0 mm, 0 mm, {2} mm], turn: [0 deg, "
          "0 "
          "deg, {3} deg]}}\n  a{0}: {{offset: [{4} mm, 0 mm, 0 mm], turn: [{5} deg, 0 deg, 0 deg]}}\n",
          i, law, d[i], theta[i], a[i], alpha[i]);
    else
      leg += fmt::format("  j{}: {{joint: motor, home: {{rz: 20 deg}}, {}: {{{}}}, {}}}\n", i, table, row, law);
  }
  if (std::string(table) == "modified_dh") leg += "  flange: {offset: [30 mm, 0 mm, 0 mm]}\n";
  return leg;
}

TEST(Serial, StandardRowsModifiedRowsAndOffsetsDescribeTheSameArm) {
  const Mechanism arms[] = {parse_mechanism(puma("dh"), "dh"), parse_mechanism(puma("modified_dh"), "modified"),
                            parse_mechanism(puma("offsets"), "offsets")};
  std::mt19937 random(6);
  for (int i = 0; i < 50; ++i) {
    Vector6 q;
    q << test::random_vector(random, 3), test::random_vector(random, 3);
    const Configuration first = configure_joints(arms[0], q);
    for (const Mechanism& arm : arms) {
      const Configuration c = configure_joints(arm, q);
      EXPECT_LE(test::distance(c.pose, first.pose), 1e-13) << arm.name;
      // The joints' axes are the same lines.
      std::vector<PlacedJoint> lines[2];
      for (const auto& [joints, of] : {std::pair{&lines[0], &c}, {&lines[1], &first}})
        for (const PlacedPart& part : of->legs[0].parts) joints->push_back(std::get<PlacedJoint>(part));
      ASSERT_EQ(lines[0].size(), 6u);
      for (std::size_t k = 0; k < 6; ++k) {
        const Vector3 z = lines[1][k].R_WJ.col(2);
        EXPECT_LE((lines[0][k].R_WJ.col(2) - z).norm(), 1e-13);
        EXPECT_LE(z.cross(lines[0][k].p_W - lines[1][k].p_W).norm(), 1e-13);
      }
    }
  }
}

}  // namespace
}  // namespace deflect
