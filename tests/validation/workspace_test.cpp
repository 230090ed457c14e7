// The regions of poses that device files state.
#include "validation/studies/workspace.h"

#include <gtest/gtest.h>

#include <set>

#include "msa/base/error.h"
#include "tests/support/devices.h"
#include "validation/measurement/random.h"
#include "validation/prediction/campaign.h"
#include "validation/studies/map.h"

namespace deflect {
namespace {

using namespace measurement;
using namespace parallel;
using namespace prediction;
using namespace studies;

Mechanism planar(const std::string& workspace) { return test::with(test::device("3-rrr"), "workspace", workspace); }

std::vector<Vector3> positions(const Mechanism& m) {
  std::vector<Vector3> out;
  for (const ValidationPoint& p : workspace_points(m)) out.push_back(p.pose_mm_deg.head<3>());
  return out;
}

TEST(Workspace, OfAPlanarMachineACubeIsASquare) {
  const Mechanism m = planar("{cube_edge: 50 mm}");
  const std::vector<Vector3> at = positions(m);
  ASSERT_EQ(at.size(), 5u);
  const Vector3 expected[] = {{0, 0, 0}, {25, 25, 0}, {-25, 25, 0}, {-25, -25, 0}, {25, -25, 0}};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_LT((at[i] - expected[i]).norm(), 1e-9) << i;
  EXPECT_EQ(workspace_grid(m, {5, 5, 5}).counts, (std::array<int, 3>{5, 5, 1}));
  // One that moves along every axis has its cube, in the order that Fig. 10 counts in.
  EXPECT_EQ(workspace_points(test::device("haptic-6psu")).size(), 9u);
}

TEST(Workspace, DiscsAndCylindersHaveTheirRims) {
  const std::vector<Vector3> disc = positions(planar("{disc: {radius: 40 mm}, centre: {shift: [10 mm, 0 mm, 0 mm]}}"));
  ASSERT_EQ(disc.size(), 9u);
  EXPECT_LT((disc[0] - Vector3(10, 0, 0)).norm(), 1e-9);
  for (std::size_t i = 1; i < 9; ++i) EXPECT_NEAR((disc[i] - disc[0]).norm(), 40, 1e-9);
  const Mechanism scara = test::with(test::device("scara"), "workspace", "{cylinder: {radius: 80 mm, height: 60 mm}}");
  const std::vector<Vector3> cylinder = positions(scara);
  ASSERT_EQ(cylinder.size(), 9u);
  std::set<double> heights;
  for (std::size_t i = 1; i < 9; ++i) {
    EXPECT_NEAR((cylinder[i] - cylinder[0]).head<2>().norm(), 80, 1e-9);
    heights.insert(std::round(cylinder[i].z() - cylinder[0].z()));
  }
  EXPECT_EQ(heights, (std::set<double>{-30, 30}));
}

TEST(Workspace, BoxesCanBeFlatAndPolygonsAnywhere) {
  EXPECT_EQ(positions(planar("{box: [40 mm, 0 mm, 0 mm]}")).size(), 3u);
  EXPECT_EQ(positions(planar("{box: [40 mm, 20 mm, 0 mm]}")).size(), 5u);
  // An L of three squares.
  const Mechanism m = planar(
      "{polygon: {corners: [{x: 0 mm, y: 0 mm}, {x: 40 mm, y: 0 mm}, {x: 40 mm, y: 20 mm}, {x: 20 mm, y: 20 mm}, {x: "
      "20 "
      "mm, y: 40 mm}, {x: 0 mm, y: 40 mm}], z: 0 mm}}");
  const std::vector<Vector3> at = positions(m);
  ASSERT_EQ(at.size(), 7u);
  EXPECT_LT((at[0] - Vector3(50.0 / 3, 50.0 / 3, 0)).norm(), 1e-9);  // the mean of (10, 10), (30, 10), (10, 30)
  const Region r = region_of(m);
  EXPECT_TRUE(r.holds({10, 30, 0}));
  EXPECT_TRUE(r.holds({40, 20, 0})) << "the rim belongs to it";
  EXPECT_FALSE(r.holds({30, 30, 0}));
  EXPECT_FALSE(r.holds({10, 10, 1}));
  Random random(3);
  for (int i = 0; i < 200; ++i) EXPECT_TRUE(r.holds(draw_pose(r, random).head<3>()));
}

TEST(Workspace, AListOfPosesIsTakenAsItStands) {
  const Mechanism m =
      planar("{poses: [{shift: [10 mm, 0 mm, 0 mm]}, {shift: [0 mm, 20 mm, 0 mm], turn: [0 deg, 0 deg, 5 deg]}]}");
  const std::vector<ValidationPoint> points = workspace_points(m);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_NEAR(points[1].pose_mm_deg(5), 5, 1e-12);
  EXPECT_EQ(points[1].label, "1");
}

TEST(Workspace, MapsLeaveOutWhatIsOutside) {
  const Mechanism m = planar("{disc: {radius: 40 mm}}");
  MapOptions o;
  o.grid = workspace_grid(m, {5, 5, 5});
  o.region = region_of(m);
  o.length_mm = 300;
  o.force_N = 10;
  const StiffnessMap map = map_stiffness(m, o, alone);
  ASSERT_EQ(map.poses.size(), 25u);
  std::size_t reached = 0;
  for (const MapPose& p : map.poses) {
    EXPECT_EQ(p.reached(), p.pose_mm_deg.head<2>().norm() < 40 + 1e-6) << p.pose_mm_deg.transpose();
    reached += p.reached();
  }
  EXPECT_EQ(reached, 13u);  // of the 5 × 5 of step 20 mm those within 40 mm
}

TEST(Workspace, CampaignsStayInIt) {
  const Mechanism m = planar("{disc: {radius: 40 mm}}");
  for (const char* name : campaign_names) {
    const Measurements plan = campaign(name, m, 10, 1);
    for (const PoseGroup& pose : plan.poses)
      EXPECT_LT(pose.pose_mm_deg.head<2>().norm(), 40 + 1e-6) << name << " " << pose.label;
  }
  EXPECT_EQ(campaign("paper", m, 10, 1).readings.size(), 27u);
}

TEST(Workspace, AMachineThatOnlyTurnsAsItMovesIsAskedForPoses) {
  const Mechanism arm = parse_mechanism(R"(
name: arm
kinematics: {family: chains}
materials: {al: {E: 70 GPa, nu: 0.33}}
sections: {tube: {shape: tube, outer_diameter: 60 mm, inner_diameter: 50 mm}}
leg:
  shoulder: {joint: motor, home: {rz: 10 deg}}
  upper_arm: {member: tube, material: al, along: [250 mm, 0 mm, 0 mm]}
  elbow: {joint: motor, home: {rz: 40 deg}}
  forearm: {member: tube, material: al, along: [200 mm, 0 mm, 0 mm]}
workspace: {cube_edge: 50 mm}
)",
                                        "arm");
  try {
    workspace_points(arm);
    FAIL();
  } catch (const ModelError& e) {
    EXPECT_NE(std::string(e.what()).find("moves along no axis of the base without turning"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("workspace: {poses:"), std::string::npos);
  }
}

// Not every command has --points.
TEST(Workspace, WithoutOneTheOptionOfEachCommandIsNamed) {
  Mechanism scara = test::device("scara");
  scara.workspace = {};
  try {
    workspace_points(scara);
    FAIL();
  } catch (const InputError& e) {
    for (const char* option : {"validate: --points", "map: --x, --y, --z", "simulate: --campaign", "plan: --before"})
      EXPECT_NE(std::string(e.what()).find(option), std::string::npos) << e.what();
  }
}

TEST(Workspace, MistakesInItAreTold) {
  const auto refusal = [](const std::string& workspace) {
    try {
      planar(workspace);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(refusal("{disk: {radius: 40 mm}}").find("workspace.disk: unknown key, did you mean 'disc'?"),
            std::string::npos)
      << refusal("{disk: {radius: 40 mm}}");
  EXPECT_NE(refusal("{cube_edge: 5 mm, disc: {radius: 40 mm}}").find("only one of 'cube_edge', 'box', 'disc'"),
            std::string::npos);
  EXPECT_NE(refusal("{box: [0 mm, 0 mm, 0 mm]}").find("needs edges that are not negative"), std::string::npos);
  EXPECT_NE(refusal("{polygon: {corners: [{x: 0 mm, y: 0 mm}, {x: 1 mm, y: 0 mm}]}}").find("enclose no area"),
            std::string::npos);
  EXPECT_NE(refusal("{poses: []}").find("needs at least one"), std::string::npos);
}

}  // namespace
}  // namespace deflect
