// `deflect simulate` as a user meets it: a measurement file, whole or not at all.
#include <gtest/gtest.h>

#include "tests/support/effects.h"
#include "tests/support/paths.h"
#include "tests/support/program.h"
#include "validation/measurement/measurements.h"

namespace deflect {
namespace {

using namespace measurement;

using test::contents;

class SimulateProgram : public ::testing::Test {
 protected:
  std::string path(const std::string& name) { return "'" + (folder / name).string() + "'"; }
  std::string file(const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return path(name);
  }
  test::Run simulate(const std::string& arguments, const std::string& out = "data.csv") {
    return test::deflect("simulate haptic-6psu-ideal-joints --campaign paper " + arguments + " -o " + path(out));
  }
  std::string made(const std::string& arguments) {
    const test::Run run = simulate(arguments);
    EXPECT_EQ(run.code, 0) << run.out;
    return contents(folder / "data.csv");
  }
  std::size_t files() {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder / "."), std::filesystem::directory_iterator()));
  }
  void expect_refused(const std::string& arguments, const std::string& message, int code = 2) {
    const std::size_t before = files();
    const test::Run run = simulate(arguments);
    EXPECT_EQ(run.code, code) << arguments << "\n" << run.out;
    EXPECT_NE(run.out.find(message), std::string::npos) << arguments << "\n" << run.out;
    EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 1) << run.out;
    EXPECT_EQ(files(), before) << arguments;
  }

  test::Folder folder;
};

TEST_F(SimulateProgram, SameSeedSameFile) {
  const std::string first = made("--seed 7"), one_thread = made("--seed 7 --threads 1"),
                    three = made("--seed 7 --threads 3");
  EXPECT_EQ(first, one_thread);
  EXPECT_EQ(first, three);
  EXPECT_NE(first, made("--seed 8"));
}

TEST_F(SimulateProgram, WritesWhatTheReaderReads) {
  const test::Run run = simulate("--noise 0.003 --noise-rotation 1e-5 --temperature 21,2");
  ASSERT_EQ(run.code, 0) << run.out;
  EXPECT_NE(run.out.find("27 readings at 9 poses of haptic-6psu-ideal-joints, nothing hidden, seed 1"),
            std::string::npos)
      << run.out;
  const Measurements m = read_measurements(folder / "data.csv");
  ASSERT_EQ(m.readings.size(), 27u);
  EXPECT_EQ(m.poses.size(), 9u);
  for (const Reading& r : m.readings) {
    EXPECT_DOUBLE_EQ(*r.sigma_u, 3e-6);
    EXPECT_DOUBLE_EQ(*r.sigma_th, 1e-5);
    for (const auto& d : r.displacement) EXPECT_TRUE(d.has_value());
    EXPECT_LE(std::abs(r.temperature_C - 21), 2);
    EXPECT_DOUBLE_EQ(r.load.norm(), 50);
  }
}

TEST_F(SimulateProgram, EffectsAddUp) {
  const std::string exact = "--noise 0 --tolerances 0 --geometry linear ";
  const auto mean_x = [&](const std::string& with) {
    made(exact + with);
    const Measurements m = read_measurements(folder / "data.csv");
    return *m.readings.front().displacement[0];  // fx = 50 N in the middle
  };
  const std::string root = "--with guide_root_compliance,stiffness_Nmm_per_rad=1e6 ",
                    tool = "--with tool_compliance,lateral_N_per_mm=500 ";
  const double none = mean_x(""), by_root = mean_x(root) - none, by_tool = mean_x(tool) - none;
  EXPECT_GT(by_root, 1e-5);
  EXPECT_NEAR(by_tool, 50 / 500e3, 1e-12);
  EXPECT_NEAR(mean_x(root + tool) - none, by_root + by_tool, 1e-9);
  const test::Run run = simulate(root + tool + "--with leg_defect,leg=4,factor=0.8");
  EXPECT_NE(run.out.find("with guide_root_compliance (all legs), tool_compliance (machine), leg_defect (leg 4)"),
            std::string::npos)
      << run.out;
}

TEST_F(SimulateProgram, TakesAPlanFromAFile) {
  made("");
  const Measurements paper = read_measurements(folder / "data.csv");
  const std::string plan = file("plan.csv",
                                "pose,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg,fx_N,fy_N,fz_N\n"
                                "here,0,0,173.9,0,0,0,10,0,0\nhere,0,0,173.9,0,0,0,-10,0,0\n");
  const test::Run run =
      test::deflect("simulate haptic-6psu-ideal-joints --campaign " + plan + " -o " + path("two.csv"));
  ASSERT_EQ(run.code, 0) << run.out;
  const Measurements two = read_measurements(folder / "two.csv");
  ASSERT_EQ(two.readings.size(), 2u);
  EXPECT_EQ(two.poses[0].label, "here");
  EXPECT_NEAR(*two.readings[0].displacement[0], -*two.readings[1].displacement[0], 2e-5);
}

TEST_F(SimulateProgram, KnowsEffectsOfOnesOwn) {
  const std::string own = file("pad.yaml", test::effect_text());
  EXPECT_EQ(simulate("--with soft_pad,stiffness_N_per_mm=300 --effects " + own).code, 0);
  expect_refused("--with soft_pad,stiffness_N_per_mm=300", "there is no effect 'soft_pad'");
}

TEST_F(SimulateProgram, RefusesEffectsThatDoNotFit) {
  expect_refused("--with joint_clearence", "there is no effect 'joint_clearence', did you mean 'joint_clearance'?");
  expect_refused("--with ''", "there is no effect ''");
  expect_refused("--with joint_clearance,gap_m=0.1", "has no parameter 'gap_m', did you mean 'gap_mm'?");
  expect_refused("--with joint_clearance,gap_mm=x", "'x' is not a finite number");
  expect_refused("--with joint_clearance,gap_mm", "write name=value");
  expect_refused("--with joint_clearance,gap_mm=0.01,gap_mm=0.02", "'gap_mm' is set twice");
  expect_refused("--with joint_clearance,gap_mm=1e9", "gap_mm=1e+09: the value must lie between");
  expect_refused("--with joint_clearance,gap_mm=1e9", "copy the effect with 'deflect effects joint_clearance --yaml'");
  expect_refused("--with modulus,factor=-1", "factor=-1: the value must lie between");
  expect_refused("--with modulus,leg=3", "it takes no leg");
  expect_refused("--with leg_defect", "say which, 1 to 6");
  expect_refused("--with leg_defect,leg=9", "there is no leg 9");
  expect_refused("--with leg_defect,leg=1.5", "a whole number");
  expect_refused("--with joint_clearance --effects /no/such.yaml", "/no/such.yaml: cannot be read");
}

TEST_F(SimulateProgram, RefusesOptionsThatCannotBe) {
  expect_refused("--noise nan", "--noise nan");
  expect_refused("--noise -1", "--noise -1");
  expect_refused("--noise inf", "--noise inf");
  expect_refused("--noise 1e-28", "--noise 1e-28");
  expect_refused("--noise-rotation nan", "--noise-rotation 'nan'");
  expect_refused("--noise-rotation=-5", "--noise-rotation -5");
  expect_refused("--noise-rotation 1e-31", "--noise-rotation 1e-31");
  expect_refused("--tolerances inf", "--tolerances inf");
  expect_refused("--outliers 0.7", "a share from 0 to 0.5");
  expect_refused("--temperature 20,nan", "--temperature '20,nan'");
  expect_refused("--temperature 20,400", "colder than -273.15 deg C");
  expect_refused("--geometry round", "write linear, second-order, finite");
  expect_refused("--elements 0", "a whole number from 1 to 1000");
  expect_refused("--seed 1.5", "--seed 1.5: give a whole number");
  expect_refused("--seed -1", "--seed -1: give a whole number");
  expect_refused("--seed 18446744073709551616",
                 "--seed 1.844674407370955e+19: give a whole number from 0 to 9000000000000000");
  expect_refused("--force 0", "other than zero");
  expect_refused("--threads 0.5", "--threads 0.5: give a whole number");
}

/// Refused at the first reading, within a fraction of a second.
const std::string too_large = "--force 1e6 --geometry second-order --elements 1";

TEST_F(SimulateProgram, NamesTheReadingThatItCannotCompute) {
  expect_refused(too_large + " --threads 1", "campaign:2: the MSA finds no equilibrium", 4);
}

// The three planar legs of a 3-RRR cannot be joined out of their plane: a shifted joint leaves a loop open.
TEST_F(SimulateProgram, SaysWhyAnOverconstrainedMachineCannotBeBuilt) {
  std::string device = contents(std::filesystem::path(test::source_dir()) / "validation/devices/3-rrr.yaml");
  const std::string tolerances = "\ntolerances:\n";
  ASSERT_NE(device.find(tolerances), std::string::npos);
  device.insert(device.find(tolerances) + tolerances.size(), "  joint_position: 0.05 mm\n");
  const std::string simulated = "simulate " + file("shifted.yaml", device) + " --campaign paper -o " + path("data.csv");
  const test::Run refused = test::deflect(simulated);
  EXPECT_EQ(refused.code, 3) << refused.out;
  for (const char* says :
       {"leg 1", "the machine as drawn can. It is over-constrained (", "joint_position", "--tolerances 0"})
    EXPECT_NE(refused.out.find(says), std::string::npos) << says << "\n" << refused.out;
  EXPECT_FALSE(std::filesystem::exists(folder / "data.csv"));
  EXPECT_EQ(test::deflect(simulated + " --tolerances 0").code, 0);
  const test::Run compared = test::deflect("compare " + path("shifted.yaml") + " " + path("data.csv"));
  EXPECT_EQ(compared.code, 3) << compared.out;
  EXPECT_NE(compared.out.find("the machine as drawn stands at every pose"), std::string::npos) << compared.out;
  EXPECT_EQ(compared.out.find("exchanged"), std::string::npos) << compared.out;
}

TEST_F(SimulateProgram, RefusesCampaignsDevicesAndFilesThatAreNone) {
  const auto expect = [&](const std::string& arguments, const std::string& message, int code = 2) {
    const test::Run run = test::deflect("simulate " + arguments);
    EXPECT_EQ(run.code, code) << run.out;
    EXPECT_NE(run.out.find(message), std::string::npos) << run.out;
  };
  const std::string device = "haptic-6psu-ideal-joints", out = " -o " + path("data.csv");
  expect(device + " --campaign papre" + out,
         "there is no campaign 'papre': take paper, cycle, rich, random, or a file");
  expect("haptic-6ps --campaign paper" + out, "did you mean 'haptic-6psu'?");
  const std::string header = "pose,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg,fx_N,fy_N,fz_N\n";
  expect(device + " --campaign " + file("bad.csv", header + "a,0,0,x,0,0,0,1,0,0\n") + out, "bad.csv:2: column 'z_mm'");
  expect(device + " --campaign " + file("far.csv", header + "a,0,0,900,0,0,0,1,0,0\n") + out, "far.csv:2: ", 3);
  EXPECT_FALSE(std::filesystem::exists(folder / "data.csv"));
  const std::size_t before = files();
  expect(device + " --campaign paper -o " + path("bad.csv/data.csv"), "bad.csv/data.csv: cannot be written");
  expect(device + " --campaign paper -o " + path("."), "cannot be written");
  expect(device + " --campaign paper", "--output is required");
  EXPECT_EQ(files(), before);
}

TEST_F(SimulateProgram, AnOldFileStaysWhereANewOneIsRefused) {
  const std::string old = made("");
  EXPECT_EQ(simulate("--with joint_clearance,gap_mm=1e9").code, 2);
  EXPECT_EQ(simulate(too_large).code, 4);
  EXPECT_EQ(contents(folder / "data.csv"), old);
}

}  // namespace
}  // namespace deflect
