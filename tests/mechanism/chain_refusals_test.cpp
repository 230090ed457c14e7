// What chains refuse, in which words; and joints that are commanded one by one.
#include <gtest/gtest.h>

#include "msa/base/error.h"
#include "tests/support/chains.h"

namespace deflect {
namespace {

using test::device;

Pose at(double x_mm, double y_mm, double z_mm, double roll_deg = 0, double pitch_deg = 0, double yaw_deg = 0) {
  return {Vector3(x_mm, y_mm, z_mm) / 1e3,
          rotation_from_rpy(roll_deg * pi / 180, pitch_deg * pi / 180, yaw_deg * pi / 180)};
}

/// The message with which an impossible model is refused.
std::string refusal(const std::function<void()>& what) {
  try {
    what();
  } catch (const ModelError& e) {
    return e.what();
  }
  return "";
}
std::string refused(const Mechanism& m, const Pose& pose) {
  return refusal([&] { configure(m, pose); });
}
std::string refused(const Mechanism& m, const VectorX& q) {
  return refusal([&] { configure_joints(m, q); });
}

void expect_says(const std::string& message, const std::vector<const char*>& phrases) {
  for (const char* phrase : phrases)
    EXPECT_NE(message.find(phrase), message.npos) << "'" << message << "' lacks: " << phrase;
}

// 750 mm + 750 mm from the axis at (y, z) = (500, 500): x = 1500 leaves √(1500² + 500²) − 1500 = 81.14 mm to the arm of
// leg 2 at least; least squares share what is left between shift and turn.
TEST(Refusal, PoseOutOfReachNamesTheLegAndWhatIsLeftOpen) {
  const Mechanism m = device("tripteron");
  expect_says(refused(m, at(1500, 500, 500)),
              {"tripteron at (1500, 500, 500) mm, (0, 0, 0) deg: leg 2: does not take this pose: 8", "mm and"});
  expect_says(refused(m, at(500, 500, 500, 5)), {"leg 2: does not take this pose: 0 mm and 5 deg are left open"});
  expect_says(refused(device("fanuc-r2000ic"), at(5000, 0, 0)), {"fanuc-r2000ic", ": does not take this pose: 2"});
}

// Two driven cranks hold the joint of their couplers; the tool is fixed to one coupler, so that its yaw depends on
// where the joint is: by the cosine rule in the triangle of crank, coupler and the line from the motor to the joint.
TEST(Refusal, AnAngleThatDependsOnThePositionIsTold) {
  const std::string text = R"(
name: fivebar
kinematics: {family: chains, home: {shift: [0 mm, 250 mm, 0 mm]HOME}}
materials: {alu: {E: 70 GPa, nu: 0.33}}
sections: {bar: {shape: box, width_y: 30 mm, height_z: 40 mm, wall: 3 mm}}
leg:
  motor: {joint: motor, home: {rz: 120 deg}}
  crank: {member: bar, material: alu, along: [180 mm, 0 mm, 0 mm]}
  elbow: {joint: revolute, home: {rz: -60 deg}}
  coupler: {member: bar, material: alu, along: [200 mm, 0 mm, 0 mm]}
mounts:
  - {base: {shift: [-100 mm, 0 mm, 0 mm]}}
  - base: {shift: [100 mm, 0 mm, 0 mm]}
    leg:
      motor: {joint: motor, home: {rz: 60 deg}}
      crank: {member: bar, material: alu, along: [180 mm, 0 mm, 0 mm]}
      elbow: {joint: revolute, home: {rz: 60 deg}}
      coupler: {member: bar, material: alu, along: [200 mm, 0 mm, 0 mm]}
      wrist: {joint: revolute, home: {rz: -120 deg}}
)";
  const auto with_home = [&](const std::string& turn) {
    std::string t = text;
    return parse_mechanism(t.replace(t.find("HOME"), 4, turn), "fivebar");
  };
  const auto yaw_at = [](double x, double y) {
    const double d = std::hypot(x + 100, y), at_joint = std::acos((200 * 200 + d * d - 180 * 180) / (2 * 200 * d));
    return (std::atan2(y, x + 100) - at_joint) * 180 / pi;
  };
  const auto told = [](const std::string& message) {
    const std::string before = "roll, pitch, yaw = 0, 0, ";
    const std::size_t from = message.find(before);
    return from == message.npos ? -1000 : std::stod(message.substr(from + before.size()));
  };
  EXPECT_NEAR(told(refusal([&] { home_pose(with_home("")); })), yaw_at(0, 250), 1e-7);
  const Mechanism m = with_home(fmt::format(", turn: [0 deg, 0 deg, {:.10f} deg]", yaw_at(0, 250)));
  EXPECT_NEAR(told(refused(m, at(10, 260, 0, 0, 0, yaw_at(0, 250)))), yaw_at(10, 260), 1e-7);
  EXPECT_EQ(refused(m, at(10, 260, 0, 0, 0, told(refused(m, at(10, 260, 0, 0, 0, yaw_at(0, 250)))))), "")
      << "can be copied";
  // Of what is out of reach nothing is told.
  EXPECT_EQ(told(refused(m, at(900, 0, 0))), -1000);
}

TEST(Refusal, LimitsNameLegJointValueAndLimit) {
  expect_says(refused(device("stewart-6ups"), at(0, 0, 3900)),
              {"leg 1: slide tz would stand at 2234.27 mm, above its limit of 2000 mm"});
  expect_says(refused(device("stewart-6ups"), at(0, 0, 100)),
              {"leg 1: slide tz would stand at", "below its limit of 100 mm"});
  expect_says(refused(device("hybrid"), at(0, 0, -1440, 60)), {"head 3 slide tz would stand at", "limit of"});
  Mechanism m = device("fanuc-r2000ic");
  m = test::with(m, "leg.joint_2.max", "{rz: 30 deg}");
  const Vector6 q = (Vector6() << 0, 0.6, 0, 0, 0.5, 0).finished();
  expect_says(refused(m, q), {"fanuc-r2000ic at joint coordinates",
                              "joint_2 rz would stand at 34.3775 deg, above its limit of 30 deg"});
}

TEST(Refusal, SingularPoseNamesTheDirectionThatIsLost) {
  // Leg 3 folded and stretched: its links lie in line. The direction's sign is open.
  expect_says(refused(device("tripteron"), at(0, 0, 500)),
              {"leg 3: singular pose: it cannot move in translation along (", "0.7071, ", "0.7071, 0)"});
  const double reach = 1500 / std::sqrt(2.0);
  expect_says(refused(device("tripteron"), at(reach, reach, 500)),
              {"leg 3: singular pose: it cannot move in translation along (", "0.7071, ", "0.7071, 0)"});
  // A wrist with axes 4 and 6 in line, reached from a pose.
  const Mechanism fanuc = device("fanuc-r2000ic");
  const Vector6 straight = (Vector6() << 0.3, 0.2, -0.1, 0.4, 0, 0.2).finished();
  const Configuration singular = configure_joints(fanuc, straight);
  expect_says(refused(fanuc, singular.pose), {"singular pose: it cannot move in rotation about ("});
}

// Where the joints are told there is nothing to invert: the arm stands, and its displacement exists.
TEST(Refusal, SingularJointCoordinatesAreTaken) {
  const Mechanism fanuc = device("fanuc-r2000ic");
  for (const double q2 : {0.0, 0.2, 0.5}) {
    const Vector6 q = (Vector6() << 0.3, q2, -0.1, 0.4, 0, 0.2).finished();
    EXPECT_EQ(refused(fanuc, q), "");
  }
}

TEST(Refusal, LoopsThatDoNotCloseAtHome) {
  expect_says(refused(test::with(device("tripteron"), "kinematics.home.shift", "[3 m, 0.5 m, 0.5 m]"), at(0, 0, 0)),
              {"leg 2: does not reach kinematics.home from the joints' home coordinates: ", "are left open"});
  Mechanism m = device("tripteron");
  std::get<Chains>(m.kinematics).home.reset();
  m.mounts[0].base.shift.y() += 5;
  expect_says(refusal([&] { home_pose(m); }),
              {"the loops do not close from the joints' home coordinates", "give kinematics.home"});
  Mechanism delta = device("delta");
  delta = test::with(delta, "leg.forearm.mounts.0.base.shift", "[0 mm, 3 m, 0 mm]");
  expect_says(refusal([&] { home_pose(delta); }), {"leg 1: does not reach kinematics.home"});
}

TEST(Refusal, WrongNumberOfJointCoordinates) {
  for (const char* name : {"tripteron", "hybrid"}) try {
      configure_joints(device(name), VectorX::Zero(4));
      FAIL();
    } catch (const InputError& e) {
      expect_says(e.what(), {name, "joint coordinates, 4 are given"});
    }
}

TEST(Refusal, ControllerThatDoesNotFitTheChain) {
  const Mechanism fanuc = device("fanuc-r2000ic");
  Mechanism m = fanuc;
  std::get<Chains>(m.kinematics).controller = MatrixX::Identity(5, 5);
  for (const auto& ask : std::vector<std::function<void()>>{
           [&] { home_pose(m); }, [&] { configure(m, home_pose(fanuc)); },
           [&] { configure_joints(m, VectorX::Zero(5)); }, [&] { configure_joints(m, VectorX::Zero(6)); }})
    EXPECT_THROW(ask(), InputError);
}

TEST(Refusal, ControllerThatAnEditLeavesWithoutItsJoint) {
  const Mechanism fanuc = device("fanuc-r2000ic");
  try {
    test::with(fanuc, "kinematics.controller", "[[1, 0], [0, 1]]");
    FAIL();
  } catch (const InputError& e) {
    expect_says(e.what(), {"kinematics.controller: has 2 rows, and the mechanism 6 actuated coordinates (joint_1, "});
  }
}

// Coordinates of any joint can be driven, those of a joint that also turns freely too.
TEST(Joints, CommandedCoordinatesAreTaken) {
  for (const char* letters : {"aaaaaa", "rrraaa", "rrrffa", "rrrafa", "rrafaf", "arafar"}) {
    Joint joint;
    joint.type = "custom";
    joint.freedoms = letters;
    Offset offset;
    offset.shift = {0.3, 0.1, 0};
    Mechanism m;
    m.kinematics = Chains();
    m.leg = {{"table", joint}, {"offset", offset}};
    const std::vector<Actuator> home = actuators_of(m);
    const auto driven = static_cast<Eigen::Index>(std::count(letters, letters + 6, 'a'));
    ASSERT_EQ(home.size(), static_cast<std::size_t>(driven));
    VectorX q = VectorX::LinSpaced(driven, 0.4, 0.9);
    const Configuration c = configure_joints(m, q);
    EXPECT_EQ(test::coordinates(c), q) << letters;
    // In the order tx ty tz Rx Ry Rz, where the free ones stay at home.
    Vector6 all = Vector6::Zero();
    for (Eigen::Index i = 0, n = 0; i < 6; ++i)
      if (letters[i] == 'a') all(i) = q(n++);
    Matrix3 R = Matrix3::Identity();
    for (Eigen::Index i = 0; i < 3; ++i) R = R * Eigen::AngleAxisd(all(3 + i), Vector3::Unit(i)).toRotationMatrix();
    EXPECT_LE((c.pose.R_WT - R).norm(), 1e-14) << letters;
    EXPECT_LE((c.pose.p_WT - all.head<3>() - R * offset.shift).norm(), 1e-14) << letters;
    for (std::size_t i = 1; i < home.size(); ++i) EXPECT_NE(home[i - 1].name, home[i].name);
  }
}

// A nested loop closes from far as it does in small steps: the path to commanded coordinates is the same.
TEST(Joints, NestedLoopsFollowTheirAssemblyOverLongWays) {
  const Mechanism m = device("hybrid");
  VectorX q(6);
  q << 0.5, -0.4, 0.39, 0.25, 0.38, 3;
  const Configuration c = configure_joints(m, q);
  EXPECT_LE((test::coordinates(configure(m, c.pose)) - q).norm(), 1e-10);
}

}  // namespace
}  // namespace deflect
