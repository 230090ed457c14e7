// What the program says of devices, frames and command lines that cannot be meant: each in one sentence with the way
// out. What it says of measurements and results stands with those.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/program.h"

namespace deflect {
namespace {

using test::contents;

const std::string arm = R"(
name: arm
kinematics: {family: chains}
materials: {al: {E: 70 GPa, nu: 0.33}}
sections: {tube: {shape: tube, outer_diameter: 60 mm, inner_diameter: 50 mm}}
leg:
  column: {member: tube, material: al, along: [0 mm, 0 mm, 300 mm]}
  shoulder: {joint: motor, rz: {law: linear, stiffness: 20000 Nm/rad}}
  upper_arm: {member: tube, material: al, along: [250 mm, 0 mm, 0 mm]}
  elbow: {joint: motor, rz: {law: linear, stiffness: 20000 Nm/rad}}
  forearm: {member: tube, material: al, along: [200 mm, 0 mm, 0 mm]}
workspace: {cube_edge: 50 mm}
)";
const std::string cantilever = R"(name: cantilever
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {rod: {shape: round, diameter: 20 mm}}
nodes: {A: [0 mm, 0 mm, 0 mm], B: [1 m, 0 mm, 0 mm]}
members: {rod: {from: A, to: B, section: rod, material: steel}}
supports: {A: clamped}
loads: {tip: {nodes: {B: {fz: 40 N}}}}
)";

class BadInputProgram : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return "'" + (folder / name).string() + "'"; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name, std::ios::binary) << text;
  }
  /// The text with one piece of it exchanged.
  static std::string with(std::string text, const std::string& old, const std::string& fresh) {
    const std::size_t at = text.find(old);
    EXPECT_NE(at, text.npos) << old;
    return text.replace(at, old.size(), fresh);
  }
  void expect(const std::string& arguments, int code, const std::string& words) const {
    const test::Run run = test::deflect(arguments);
    EXPECT_EQ(run.code, code) << arguments << "\n" << run.out.substr(0, 2000);
    EXPECT_NE(run.out.find(words), run.out.npos) << arguments << "\nwanted: " << words << "\n"
                                                 << run.out.substr(0, 2000);
    EXPECT_LT(run.out.size(), 4000u) << arguments;
  }
  void expect_device(const std::string& text, int code, const std::string& words,
                     const std::string& more = "--joints 0.3,1.2 --load 1,0,0") const {
    write("device.yaml", text);
    expect("solve " + path("device.yaml") + " " + more, code, words);
  }
  void expect_frame(const std::string& text, int code, const std::string& words) const {
    write("frame.yaml", text);
    expect("frame " + path("frame.yaml"), code, words);
  }

  test::Folder folder;
};

TEST_F(BadInputProgram, CommandsAndOptionsHaveNearestNames) {
  write("arm.yaml", arm);
  expect("solv " + path("arm.yaml"), 2,
         "deflect: there is no command 'solv', did you mean 'solve'? (known: new, show, solve, ");
  expect("Diagnose a b", 2, "there is no command 'Diagnose', did you mean 'diagnose'?");
  expect("xyzzy", 2, "there is no command 'xyzzy' (known: new, show, solve, ");
  expect("", 2, "give a command: new, show, solve, validate, ");
  expect("solve " + path("arm.yaml") + " --lod 1,0,0", 2,
         "deflect: solve has no option '--lod', did you mean '--load'? (known: --pose, --joints, --load, ");
  expect("solve " + path("arm.yaml") + " --lod=1,0,0", 2, "solve has no option '--lod', did you mean '--load'?");
  expect("simulate " + path("arm.yaml") + " --oput x.csv", 2,
         "simulate has no option '--oput', did you mean '--output'?");
  expect("solve " + path("arm.yaml") + " -x", 2, "solve has no option '-x' (known: ");
  // Values that begin with a minus are none.
  expect("solve " + path("arm.yaml") + " --joints -0.3,1.2 --load -1,0,0", 0, "load   fx -1");
  expect("solve", 2, "device is required");
}

TEST_F(BadInputProgram, TheOtherKindOfFileIsNamedWithItsCommand) {
  write("frame.yaml", cantilever);
  write("arm.yaml", arm);
  write("data.csv", "pose,q1_rad,q2_rad,fx_N,ux_mm\n0,0.3,1.2,1,0\n1,0.3,1.3,1,0\n");
  const std::string frame = "frame.yaml:4: this file describes a frame (it has 'nodes'), not a device: 'deflect frame ";
  expect("compare " + path("frame.yaml") + " " + path("data.csv"), 2,
         "data.csv:1: the measured thing is a frame that has");
  expect("solve " + path("frame.yaml"), 2, frame);
  expect("solve logan-5-8", 2, "'logan-5-8' is a frame, not a device: 'deflect frame logan-5-8' solves it");
  expect("compare logan-5-8 " + path("data.csv"), 2, "has no sensors");
  expect("frame haptic-6psu", 2, "'haptic-6psu' is a device, not a frame: 'deflect solve haptic-6psu' and the other");
  expect("frame " + path("arm.yaml"), 2, "arm.yaml:3: this file describes a device (it has 'kinematics'), not a frame");
  expect("effects --effects " + path("arm.yaml"), 2, "describes a device (it has 'kinematics'), not an effect");
}

TEST_F(BadInputProgram, FilesThatAreNoTextOrHaveNoEnd) {
  expect_device("name: deep\nkinematics: " + std::string(20000, '[') + std::string(20000, ']') + "\n", 2,
                "device.yaml:2: is nested too deeply: ");
  std::string wide = "\xFF\xFE";
  for (const char c : arm) (wide += c) += '\0';
  expect_device(wide, 2, "device.yaml:1: the file is UTF-16: save it as UTF-8");
  expect("solve /dev/zero --joints 1", 2, "/dev/zero: does not end: 256 MB were read");
}

TEST_F(BadInputProgram, NamesFitOnALine) {
  expect_device(with(arm, "name: arm", "name: \"arm\\nof two lines\""), 2,
                "device.yaml:2: name: has a line break or a tab in it: write one line");
  expect_device(with(arm, "name: arm", "name: " + std::string(100000, 'a')), 2,
                "device.yaml:2: name: is 100000 characters long: write at most 200");
  expect_frame(with(cantilever, "name: cantilever", "name: \"a\\tb\""), 2, "frame.yaml:1: name: has a line break");
}

TEST_F(BadInputProgram, SizesHaveLimits) {
  expect_device(with(arm, "250 mm", "1e30 m"), 2,
                "device.yaml:9: leg.upper_arm.along.0: '1e30 m' is too large for a length: at most 1e+06 m");
  expect_frame(with(cantilever, "[1 m,", "[1e30 m,"), 2, "nodes.B.0: '1e30 m' is too large for a length");
  expect_frame(with(cantilever, "40 N", "1e300 N"), 2,
               "frame.yaml:7: loads.tip.nodes.B.fz: '1e300 N' is too large for a force: at most 1e+15 N");
  write("arm.yaml", arm);
  expect("solve " + path("arm.yaml") + " --joints 0,1 --load 1e300,0,0", 2,
         "--load '1e300,0,0': 1e+300 N is too large: at most 1e+15");
}

TEST_F(BadInputProgram, SoftMaterialsAreReadWithAQuestion) {
  const std::string question = "softer than plastics (0.3 GPa and more; metals 40 to 400 GPa): are GPa meant?";
  expect_device(with(arm, "70 GPa", "70 MPa"), 0, "device.yaml: materials.al.E: 0.07 GPa is " + question);
  expect_frame(with(cantilever, "210 GPa", "210 MPa"), 0, "materials.steel.E: 0.21 GPa is " + question);
  // So soft that nothing is left of it: the question comes before the answer, or before the refusal.
  write("device.yaml", with(arm, "70 GPa", "1e-300 GPa"));
  const test::Run run = test::deflect("solve " + path("device.yaml") + " --joints 0.3,1.2 --load 1,0,0");
  EXPECT_NE(run.out.find("note: " + (folder / "device.yaml").string() + ": materials.al.E: 1e-300 GPa is " + question),
            run.out.npos)
      << run.out;
  for (const std::string device : {"haptic-6psu", "tripteron"}) {
    const test::Run hard = test::deflect("map --n 1 " + device);
    EXPECT_EQ(hard.out.find("GPa is"), hard.out.npos) << hard.out;
  }
  write("device.yaml", with(arm, "70 GPa", "70 MPa"));
  EXPECT_EQ(test::deflect("solve " + path("device.yaml") + " --joints 0.3,1.2 --quiet").out, "");
}

TEST_F(BadInputProgram, NothingDrivenTakesNoJoints) {
  const std::string rigid = with(with(arm, "joint: motor", "joint: fixed"), "joint: motor", "joint: fixed");
  expect_device(rigid, 2, "--joints '0.3,1.2': arm has no actuator: omit --joints");
  expect_device(rigid, 0, "relative difference", "--load 1,0,0");
  expect_device(arm, 2, "give either --pose", "--load 1,0,0");
}

TEST_F(BadInputProgram, AMapOfNothingIsNoResult) {
  expect("map haptic-6psu --z 900,1000 --n 3 --json " + path("map.json"), 3,
         "the map is empty: the device reaches none of the 27 poses; give --x, --y, --z or --tilt. The first pose: "
         "haptic-6psu at (-25, -25, 900) mm");
  EXPECT_FALSE(std::filesystem::exists(folder / "map.json"));
}

TEST_F(BadInputProgram, ANewFolderIsSaid) {
  const std::string solve = "solve haptic-6psu --pose 0,0,173.9 --load 50,0,0 --json ";
  const std::string said = "note: creating the folder " + (folder / "new/dir").string();
  expect(solve + path("new/dir/x.json"), 0, said);
  const test::Run again = test::deflect(solve + path("new/dir/x.json"));
  EXPECT_EQ(again.out.find(said), again.out.npos) << again.out;
}

TEST_F(BadInputProgram, AnEffectThatPointsNowhereSaysWhere) {
  const std::string effect = R"(name: pad
title: A pad
scope: machine
parameters:
  k_N_per_mm: {start: 500, low: 10, high: 1e5, scale: log, vanishes: infinity, about: stiffness}
edits:
  - {at: PATH, append: {law: linear, stiffness: $k_N_per_mm}}
pages: {machine: a, data: b, bench: c, cure: d}
)";
  const auto add = [&](const std::string& at, const std::string& words) {
    write("pad.yaml", with(effect, "PATH", at));
    expect("add haptic-6psu pad --effects " + path("pad.yaml") + " --set k_N_per_mm=100 -o " + path("n.yaml"), 2,
           words);
    EXPECT_FALSE(std::filesystem::exists(folder / "n.yaml"));
  };
  add("tool.zz",
      "pad.yaml:7: edits.0: edit 'tool.zz += {law: linear, stiffness: 100 N/mm}': tool.zz: there is no 'zz'");
  add("leg.*.zz", "leg.*.zz += {law: linear, stiffness: 100 N/mm}': leg.actuator.zz: there is no 'zz'");
  add("leg.carrage.tz", "leg.carrage: there is no 'carrage', did you mean 'carriage'?");
  add("'leg.universal_joint.tz[1].radius'", "entries of a list are numbered from 0, behind a dot: 'tz.1'");
  add("[leg.carrage.tz, leg.x.tz]", "edits.0: leg.carrage: there is no 'carrage', did you mean 'carriage'?");
}

}  // namespace
}  // namespace deflect
