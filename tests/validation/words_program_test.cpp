// The user's words as they are meant: angles and coordinates without digits, displacements too large for their theory.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/program.h"

namespace deflect {
namespace {

using nlohmann::json;
using test::contents;

class Words : public ::testing::Test {
 protected:
  Words() { write("arm.yaml", arm); }
  std::string path(const std::string& name) const { return "'" + (folder / name).string() + "'"; }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }
  test::Run solve(const std::string& arguments) const {
    return test::deflect("solve " + path("arm.yaml") + " --json " + path("r.json") + " " + arguments);
  }
  json result() const { return json::parse(contents(folder / "r.json")); }

  const std::string arm = R"(
name: arm
kinematics: {family: chains}
materials: {al: {E: 70 GPa, nu: 0.33}}
sections: {tube: {shape: tube, outer_diameter: 60 mm, inner_diameter: 50 mm}}
leg:
  column: {member: tube, material: al, along: [0 mm, 0 mm, 300 mm]}
  shoulder: {joint: motor, rz: {law: linear, stiffness: 20000 Nm/rad}}
  upper_arm: {member: tube, material: al, along: [250 mm, 0 mm, 0 mm]}
  lift: {joint: prismatic}
  forearm: {member: tube, material: al, along: [200 mm, 0 mm, 0 mm]}
workspace: {cube_edge: 50 mm}
)";
  test::Folder folder;
};

TEST_F(Words, CoordinatesWithoutDigitsAreRefused) {
  for (const char* joints : {"1e15,1", "1e300,1", "'1e9 deg,1'", "-1e7,1"}) {
    const test::Run run = solve(std::string("--joints=") + joints + " --load 1,0,0");
    EXPECT_EQ(run.code, 2) << joints << run.out;
    EXPECT_NE(run.out.find("too few of its digits are left: write the same angle within one turn"), std::string::npos)
        << run.out;
    EXPECT_NE(run.out.find("shoulder"), std::string::npos) << run.out;
  }
  for (const char* joints : {"inf,1", "nan,1", "1,inf"})
    EXPECT_EQ(solve(std::string("--joints=") + joints + " --load 1,0,0").code, 2) << joints;
  const test::Run far = solve("--joints 0.3,1e15 --load 1,0,0");
  EXPECT_EQ(far.code, 2);
  EXPECT_NE(far.out.find("joint lift: 1e+15 mm is 1.85e+12 times the mechanism's size"), std::string::npos) << far.out;
  const test::Run pose = test::deflect("solve stewart-6ups --pose 0,0,2000,0,0,1e15 --load 1,0,0");
  EXPECT_EQ(pose.code, 2);
  EXPECT_NE(pose.out.find("--pose '0,0,2000,0,0,1e15': '1e+15 deg' is an angle of 2.78e+12 turns"), std::string::npos)
      << pose.out;
  EXPECT_EQ(test::deflect("solve stewart-6ups --pose 0,0,1e300 --load 1,0,0").code, 3);
  write("turned.yaml",
        std::string(arm).replace(arm.find("{joint: motor,"), 14, "{joint: motor, home: {rz: 1e12 deg},"));
  EXPECT_EQ(test::deflect("solve " + path("turned.yaml") + " --joints 0,0").code, 2);
}

TEST_F(Words, WholeTurnsChangeNothing) {
  ASSERT_EQ(solve("--joints '5 deg,10' --load 10,20,30").code, 0);
  const json near = result();
  for (const char* joints : {"'725 deg,10'", "'-715 deg,10'", "'360005 deg,10'"}) {
    const test::Run run = solve(std::string("--joints=") + joints + " --load 10,20,30");
    ASSERT_EQ(run.code, 0) << run.out;
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_NEAR(result()["msa"]["displacement"][i].get<double>(), near["msa"]["displacement"][i].get<double>(), 1e-9);
  }
  // A limit is one of the coordinate as it is commanded.
  const test::Run beyond = test::deflect("solve delta --joints='365 deg,0.2,0.1'");
  EXPECT_EQ(beyond.code, 3);
  EXPECT_NE(beyond.out.find("motor rz would stand at 365 deg, above its limit of 95 deg"), std::string::npos)
      << beyond.out;
}

TEST_F(Words, AnglesOfMeasurementsAreReadWithTheSameCare) {
  write("data.csv",
        "pose,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg,fx_N,fy_N,fz_N,ux_mm\n"
        "0,0,0,2000,0,0,9e11,1,0,0,0.1\n1,0,0,2000,0,0,0,1,0,0,0.1\n");
  const test::Run run = test::deflect("compare stewart-6ups " + path("data.csv"));
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.out.find("data.csv:2: column 'yaw_deg': '9e11' is an angle of"), std::string::npos) << run.out;
}

TEST_F(Words, LinearAnswersThatAreNotSmallSaySo) {
  const test::Run small = solve("--joints 0.3,0 --load 0,0,-100");
  ASSERT_EQ(small.code, 0);
  EXPECT_EQ(small.out.find("not small"), std::string::npos) << small.out;
  EXPECT_FALSE(result().contains("notes"));
  const test::Run large = solve("--joints 0.3,0 --load 0,0,-40000");
  ASSERT_EQ(large.code, 0);
  EXPECT_NE(large.out.find("note: displacements are not small: parts turn by up to 0."), std::string::npos)
      << large.out;
  EXPECT_NE(large.out.find("solve with --geometry finite"), std::string::npos);
  ASSERT_EQ(result()["notes"].size(), 1u);
  EXPECT_NE(result()["notes"][0].get<std::string>().find("not small"), std::string::npos);
}

/// A cantilever of 1 m, P L²/(2 E I) = 0.2 rad at the tip, 0.133 m there; and half of its slope's limit.
TEST_F(Words, FramesSayItByLoadCase) {
  const auto frame = [&](const std::string& geometry) {
    write("frame.yaml", R"(
name: cantilever
)" + geometry + R"(
materials: {soft: {E: 100 GPa, nu: 0.3}}
sections: {rod: {shape: given, A: 100 mm^2, Iy: 1000 mm^4, Iz: 1000 mm^4, J: 1000 mm^4}}
nodes: {A: [0 mm, 0 mm, 0 mm], B: [1 m, 0 mm, 0 mm]}
members: {rod: {from: A, to: B, section: rod, material: soft}}
supports: {A: clamped}
loads: {much: {nodes: {B: {fz: 40 N}}}, little: {nodes: {B: {fz: 10 N}}}}
)");
    const test::Run run = test::deflect("frame " + path("frame.yaml") + " --json " + path("f.json"));
    EXPECT_EQ(run.code, 0) << run.out;
    return run.out;
  };
  const std::string linear = frame("");
  EXPECT_NE(
      linear.find("note: load case 'much': displacements are not small: parts turn by up to 0.2 rad and move by up "
                  "to 133.3 mm, 13 % of"),
      std::string::npos)
      << linear;
  EXPECT_NE(linear.find("leaves out 2 % of lengths"), std::string::npos) << linear;
  EXPECT_EQ(linear.find("case 'little': displacements"), std::string::npos) << linear;
  EXPECT_EQ(json::parse(contents(folder / "f.json"))["notes"].size(), 1u);
  EXPECT_EQ(frame("geometry: finite\nload_steps: 4").find("not small"), std::string::npos);
}

}  // namespace
}  // namespace deflect
