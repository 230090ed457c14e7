// Every result file says what it was made from, and can be made again.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/paths.h"
#include "tests/support/program.h"

namespace deflect {
namespace {

using Json = nlohmann::ordered_json;

class ReproduceProgram : public ::testing::Test {
 protected:
  test::Run in_folder(const std::string& arguments) {
    return test::command("cd '" + (folder / ".").string() + "' && '" + test::program() + "' " + arguments);
  }
  void make(const std::string& arguments) {
    const test::Run run = in_folder(arguments);
    ASSERT_EQ(run.code, 0) << arguments << "\n" << run.out;
  }
  Json result(const std::string& name) { return Json::parse(test::contents(folder / name)); }
  void write(const std::string& name, const Json& json) { std::ofstream(folder / name) << json.dump(2); }
  void expect_reproduced(const std::string& name) {
    const test::Run run = in_folder("reproduce " + name);
    EXPECT_EQ(run.code, 0) << name << "\n" << run.out;
  }
  void expect_refused(const std::string& arguments, int code, const std::string& words) {
    const test::Run run = in_folder("reproduce " + arguments);
    EXPECT_EQ(run.code, code) << run.out;
    EXPECT_NE(run.out.find(words), std::string::npos) << run.out;
  }

  test::Folder folder;
};

TEST_F(ReproduceProgram, EveryCommandWithAResultIsReproduced) {
  make(
      "simulate haptic-6psu-ideal-joints --campaign paper --with joint_clearance,gap_mm=0.02 --seed 7 -o data.csv "
      "--json "
      "simulate.json");
  make("solve haptic-6psu --pose 25,25,198.9 --load=-50,0,0 --json solve.json");
  make("solve haptic-6psu --pose 25,25,198.9 --load=50,0,0 --json drawn.json --out drawn");
  make("validate haptic-6psu --json validate.json");
  make("map haptic-6psu --n 3 --x=-20,20 --y=-20,20 --z 160,200 --json map.json");
  make("frame logan-5-8 --json frame.json");
  make("show scara --json show.json");
  make("compare haptic-6psu-ideal-joints data.csv --json compare.json");
  make("diagnose haptic-6psu-ideal-joints data.csv --bootstrap 99 --json diagnose.json");
  make("add haptic-6psu-ideal-joints joint_clearance --set gap_mm=0.02 -o after.yaml --json add.json");
  make("history data.csv haptic-6psu-ideal-joints after.yaml --json history.json");
  make("check solve.json --device haptic-6psu --pose 25,25,198.9 --load=-50,0,0 --json check.json");
  for (const char* name : {"simulate", "solve", "drawn", "validate", "map", "frame", "show", "compare", "diagnose",
                           "add", "history", "check"})
    expect_reproduced(std::string(name) + ".json");
  // What is written besides is not touched.
  EXPECT_EQ(result("simulate.json")["provenance"]["outputs"][0]["name"], "data.csv");
}

TEST_F(ReproduceProgram, TheProvenanceNamesWhatMatters) {
  make("simulate 3-rrr --campaign paper --seed 5 -o data.csv");
  make("compare 3-rrr data.csv --threads 1 --json one.json");
  make("compare 3-rrr data.csv --threads 2 --json two.json --quiet");
  EXPECT_EQ(test::contents(folder / "one.json"), test::contents(folder / "two.json"));
  const Json p = result("one.json")["provenance"];
  EXPECT_EQ(p["program"].get<std::string>().rfind("deflect ", 0), 0u);
  EXPECT_EQ(p["command"], Json({"compare", "3-rrr", "data.csv"}));
  ASSERT_EQ(p["inputs"].size(), 2u);
  EXPECT_EQ(p["inputs"][1]["name"], "data.csv");
  const test::Run sum = in_folder("devices 3-rrr > device.yaml && sha256sum < device.yaml");
  EXPECT_EQ(sum.out.substr(0, 64), p["inputs"][0]["sha256"]);
  for (const char* name : {"system", "processor", "compiler"}) EXPECT_TRUE(p["machine"][name].is_string()) << name;
}

TEST_F(ReproduceProgram, ADifferenceIsNamedByItsPath) {
  make("solve haptic-6psu --pose 0,0,198.9 --load 0,0,50 --json solve.json");
  Json changed = result("solve.json");
  const double u = changed["msa"]["displacement"][2];
  changed["msa"]["displacement"][2] = u * (1 + 1e-8);
  write("changed.json", changed);
  expect_refused("changed.json", 4, "msa.displacement[2]");
  EXPECT_EQ(in_folder("reproduce changed.json --tolerance 1e-7").code, 0);
  make("solve haptic-6psu --pose 0,0,198.9 --load 0,0,50 --json solve.json");
  changed = result("solve.json");
  changed["checks"]["symmetric"] = false;
  changed.erase("relative_difference");
  write("changed.json", changed);
  expect_refused("changed.json --json told.json", 4, "checks.symmetric: true instead of false");
  EXPECT_EQ(result("told.json")["same"], false);
  EXPECT_EQ(result("told.json")["differences"].size(), 2u);
}

TEST_F(ReproduceProgram, InputsThatChangedOrAreMissingAreRefused) {
  make("devices 3-rrr > mine.yaml");
  make("solve mine.yaml --load 5,0,0 --joints 0,0,0 --json solve.json || '" + test::program() +
       "' show mine.yaml --json solve.json");
  std::ofstream(folder / "mine.yaml", std::ios::app) << "# another line\n";
  expect_refused("solve.json", 2, "mine.yaml has changed");
  std::filesystem::remove(folder / "mine.yaml");
  expect_refused("solve.json", 2, "mine.yaml is missing");
}

TEST_F(ReproduceProgram, InputsAreFoundNextToTheResult) {
  make("devices 3-rrr > mine.yaml");
  make("show mine.yaml --json show.json");
  const test::Run run = test::deflect("reproduce '" + (folder / "show.json").string() + "'");
  EXPECT_EQ(run.code, 0) << run.out;
}

TEST_F(ReproduceProgram, SaysFromWhichFolderInputsAreMissing) {
  make("devices 3-rrr > mine.yaml");
  make("show mine.yaml --json show.json");
  std::ofstream(folder / "mine.yaml", std::ios::app) << "# another line\n";
  const test::Run run =
      test::command("cd / && '" + test::program() + "' reproduce '" + (folder / "show.json").string() + "'");
  EXPECT_EQ(run.code, 2) << run.out;
  EXPECT_NE(run.out.find("Seen from /: mine.yaml is missing"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("Seen from " + (folder / "").parent_path().string() + ": mine.yaml has changed"),
            std::string::npos)
      << run.out;
}

// Plans read a diagnosis or a campaign, fits and predictions a description: all are inputs.
TEST_F(ReproduceProgram, FitsPredictionsAndPlansNameTheirInputs) {
  make("simulate 3-rrr --campaign paper --seed 5 -o data.csv");
  make("devices 3-rrr > mine.yaml");
  make("fit mine.yaml data.csv --free materials.aluminium.E -o fitted.yaml --json fit.json");
  make("predict fitted.yaml --plan data.csv --fit fit.json --json predict.json");
  make("plan mine.yaml --before data.csv --json plan.json");
  const auto inputs = [&](const std::string& name) {
    std::vector<std::string> out;
    const Json all = result(name)["provenance"]["inputs"];
    for (const Json& input : all) out.push_back(input["name"]);
    return out;
  };
  EXPECT_EQ(inputs("fit.json"), (std::vector<std::string>{"mine.yaml", "data.csv"}));
  EXPECT_EQ(inputs("predict.json"), (std::vector<std::string>{"fitted.yaml", "data.csv", "fit.json"}));
  EXPECT_EQ(inputs("plan.json"), (std::vector<std::string>{"mine.yaml", "data.csv", "effects/catalogue"}));
  for (const char* name : {"fit.json", "predict.json", "plan.json"}) expect_reproduced(name);
}

TEST_F(ReproduceProgram, WhatIsNoResultIsRefused) {
  std::ofstream(folder / "list.json") << "[1, 2]";
  expect_refused("list.json", 2, "provenance");
  std::ofstream(folder / "text.json") << "verdict";
  expect_refused("text.json", 2, "not valid JSON");
  make("solve haptic-6psu --pose 0,0,198.9 --json solve.json");
  Json changed = result("solve.json");
  changed["provenance"]["command"][0] = "new";
  write("changed.json", changed);
  expect_refused("changed.json", 2, "no command that writes results");
  changed = result("solve.json");
  changed["provenance"]["command"].push_back("--out=elsewhere");
  write("changed.json", changed);
  expect_refused("changed.json", 2, "would write a file");
  changed["provenance"]["inputs"] = 3;
  write("changed.json", changed);
  expect_refused("changed.json", 2, "provenance.inputs");
}

}  // namespace
}  // namespace deflect
