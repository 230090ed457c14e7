// What a device or an entry of the catalogue cannot do ends neither `compare` nor `diagnose`.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/support/program.h"

namespace deflect {
namespace {

using nlohmann::json;
using test::contents;

class LeftOutProgram : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return "'" + (folder / name).string() + "'"; }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }
  json diagnosis(const std::string& device, const std::string& more = "") const {
    const test::Run run = test::deflect("diagnose " + device + " " + path("data.csv") + " --bootstrap 199 --json " +
                                        path("d.json") + " " + more);
    EXPECT_EQ(run.code, 0) << run.out;
    if (run.code != 0) return json();
    json d = json::parse(contents(folder / "d.json"));
    std::set<std::string> once;
    for (const json& e : d["left_out"]) EXPECT_TRUE(once.insert(e["effect"]).second) << e << " is left out twice";
    return d;
  }
  static std::string why_left_out(const json& d, const std::string& effect) {
    for (const json& e : d["left_out"])
      if (e["effect"] == effect) return e["why"];
    return "";
  }

  test::Folder folder;
};

/// A blade, and a plate on two springs: nothing of either is driven.
const char* blade = R"(
name: blade
kinematics: {family: chains}
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {blade: {shape: rectangle, width_y: 10 mm, height_z: 4 mm}}
leg: {blade: {member: blade, material: steel, along: [100 mm, 0 mm, 0 mm]}}
workspace: {cube_edge: 10 mm}
)";
const char* plate = R"(
name: plate
kinematics: {family: chains, home: {shift: [0 mm, 0 mm, 50 mm]}}
mounts:
  - {base: {shift: [30 mm, 0 mm, 50 mm]}, platform: {shift: [30 mm, 0 mm, 0 mm]}}
  - {base: {shift: [-30 mm, 0 mm, 50 mm]}, platform: {shift: [-30 mm, 0 mm, 0 mm]}}
leg:
  spring:
    joint: fixed
    stiffness:
      rows: [[1000, 0, 0, 0, 0, 0], [0, 1000, 0, 0, 0, 0], [0, 0, 200, 0, 0, 0], [0, 0, 0, 1e6, 0, 0],
             [0, 0, 0, 0, 1e6, 0], [0, 0, 0, 0, 0, 1e6]]
workspace: {cube_edge: 10 mm}
)";

TEST_F(LeftOutProgram, AMechanismWithoutADriveIsComparedAndDiagnosed) {
  for (const auto& [device, pose] : {std::pair(blade, "100,0,0"), std::pair(plate, "0,0,50")}) {
    write("device.yaml", device);
    std::string plan = "pose,sequence,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg,fx_N,fy_N,fz_N\n";
    int row = 0;
    for (const char* load : {"5,0,0", "-5,0,0", "0,5,0", "0,-5,0", "0,0,5", "0,0,-5", "3,3,3", "-3,-3,-3"})
      plan += "0," + std::to_string(row++) + "," + pose + ",0,0,0," + load + "\n";
    write("plan.csv", plan);
    const test::Run simulated = test::deflect("simulate " + path("device.yaml") + " --campaign " + path("plan.csv") +
                                              " --noise 0.0001 --with load_gain,factor=1.2 -o " + path("data.csv"));
    ASSERT_EQ(simulated.code, 0) << simulated.out;
    const test::Run compared = test::deflect("compare " + path("device.yaml") + " " + path("data.csv"));
    EXPECT_EQ(compared.code, 0) << compared.out;
    EXPECT_NE(compared.out.find("by one factor, 1.2"), std::string::npos) << compared.out;
    const json d = diagnosis(path("device.yaml"));
    EXPECT_EQ(d["candidates"][0]["effect"], "load_gain");
    EXPECT_NE(why_left_out(d, "actuator_compliance").find("nothing is driven"), std::string::npos);
  }
}

// The tables of a diagnosis say what its JSON says, in the same order.
TEST_F(LeftOutProgram, TablesOfADiagnosis) {
  ASSERT_EQ(
      test::deflect("simulate tripteron --campaign random --with load_gain,factor=1.2 -o " + path("data.csv")).code, 0);
  const json d = diagnosis("tripteron", "--out " + path("tables"));
  EXPECT_NE(contents(folder / "tables" / "diagnosis.txt").find(d["sentence"].get<std::string>()), std::string::npos);
  const auto rows_of = [&](const char* name) {
    std::vector<std::string> rows;
    std::istringstream lines(contents(folder / "tables" / name));
    for (std::string line; std::getline(lines, line);) rows.push_back(line);
    return rows;
  };
  const std::vector<std::string> rows = rows_of("candidates.csv");
  ASSERT_GT(rows.size(), 3u);
  EXPECT_EQ(rows[0], "effect,leg,probability,rmse_mm,held_out_rmse_mm,chi2_per_dof,parameter,unit,value,low95,high95");
  const auto commas = std::count(rows[0].begin(), rows[0].end(), ',');
  for (const std::string& row : rows) EXPECT_EQ(std::count(row.begin(), row.end(), ','), commas) << row;
  const json& first = d["candidates"][0];
  EXPECT_TRUE(rows[1].starts_with("\"" + first["effect"].get<std::string>() + "\",,")) << rows[1];
  EXPECT_NE(rows[1].find(fmt::format(",factor,\"\",{:.6g},", first["parameters"][0]["value"].get<double>())),
            std::string::npos)
      << rows[1];
  EXPECT_TRUE(rows.end()[-2].starts_with("\"nothing\",,")) << rows.end()[-2];
  EXPECT_TRUE(rows.end()[-1].starts_with("something unknown,,")) << rows.end()[-1];
  const std::vector<std::string> sizes = rows_of("detectable.csv");
  ASSERT_GT(sizes.size(), 1u);
  EXPECT_EQ(sizes[0], "effect,leg,parameter,unit,smallest,mistaken_for,cosine");
}

/// The links' aluminium states G: its moduli go together, or Poisson's ratio leaves its bounds.
TEST_F(LeftOutProgram, AStrongElasticDeviationIsDiagnosedWhereAMaterialGivesItsShearModulus) {
  write("moduli.yaml", R"(
name: young_alone
title: E without G
scope: machine
parameters:
  factor: {start: 0.95, low: 0.3, high: 3, scale: log, vanishes: 1, about: true over stated}
edits:
  - {at: materials.*.E, multiply: $factor}
pages: {machine: a, data: b, bench: c, cure: d}
)");
  write("never.yaml", R"(
name: never
title: No value of it can be had
scope: machine
parameters:
  factor: {start: 5, low: 4, high: 6, vanishes: 1, about: true over stated}
edits:
  - {at: materials.*.E, multiply: $factor}
pages: {machine: a, data: b, bench: c, cure: d}
)");
  ASSERT_EQ(test::deflect("simulate tripteron --campaign random --with actuator_compliance,stiffness_N_per_mm=20 -o " +
                          path("data.csv"))
                .code,
            0);
  const json d = diagnosis("tripteron", "--effects " + path("moduli.yaml") + " " + path("never.yaml"));
  EXPECT_EQ(d["missing"], json::array({"actuator_compliance"}));
  EXPECT_EQ(why_left_out(d, "modulus"), "");
  EXPECT_NE(why_left_out(d, "never").find("Poisson's ratio"), std::string::npos) << d["left_out"];
  bool tried = false;
  for (const json& c : d["candidates"]) tried = tried || c["effect"] == "young_alone";
  EXPECT_TRUE(tried) << "what some values cannot have is still tried at others";
}

TEST_F(LeftOutProgram, TheModulusIsThatOfTheWholeMaterial) {
  for (const auto& [name, factor] : {std::pair("half.yaml", "0.5"), std::pair("twice.yaml", "2")}) {
    const test::Run run =
        test::deflect(std::string("add tripteron modulus --set factor=") + factor + " -o " + path(name));
    ASSERT_EQ(run.code, 0) << run.out;
  }
  EXPECT_NE(contents(folder / "half.yaml").find("{E: 35 GPa, G: 12.75 GPa}"), std::string::npos);
  const auto displaced = [&](const std::string& device) {
    const test::Run run =
        test::deflect("solve " + device + " --pose 500,500,500 --load 10,20,-30 --json " + path("solve.json"));
    EXPECT_EQ(run.code, 0) << run.out;
    return json::parse(contents(folder / "solve.json"))["analytic"]["displacement"].get<std::vector<double>>();
  };
  // Drives are springs; what the members add goes with one over the factor: 2, 1 and 1/2 times.
  const std::vector<double> whole = displaced("tripteron"), half = displaced(path("half.yaml")),
                            twice = displaced(path("twice.yaml"));
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(half[i] - whole[i], 2 * (whole[i] - twice[i]), 1e-9 * std::abs(half[i]));
}

}  // namespace
}  // namespace deflect
