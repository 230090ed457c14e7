// `deflect history` as a user meets it, at the end of the loop: measure, diagnose, add, look again.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/support/program.h"

namespace deflect {
namespace {

using nlohmann::json;
using test::contents;

class HistoryProgram : public ::testing::Test {
 protected:
  std::string path(const std::string& name) { return "'" + (folder / name).string() + "'"; }
  std::string file(const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return path(name);
  }
  void simulate(const std::string& arguments = "") {
    const test::Run run = test::deflect(
        "simulate haptic-6psu-ideal-joints --campaign paper --with guide_root_compliance,stiffness_Nmm_per_rad=1e6 " +
        arguments + " -o " + path("data.csv"));
    ASSERT_EQ(run.code, 0) << run.out;
  }
  test::Run history(const std::string& devices) {
    return test::deflect("history " + path("data.csv") + " " + devices + " --json " + path("history.json") + " --out " +
                         path("out"));
  }
  void expect_refused(const std::string& arguments, const std::string& message, int code = 2) {
    const test::Run run = history(arguments);
    EXPECT_EQ(run.code, code) << run.out;
    EXPECT_NE(run.out.find(message), std::string::npos) << run.out;
    EXPECT_FALSE(std::filesystem::exists(folder / "history.json"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  }

  test::Folder folder;
};

TEST_F(HistoryProgram, TheErrorFallsWithWhatADiagnosisAdds) {
  simulate("--seed 5");
  const auto diagnosis = [&](double value) {
    return file("d.json", R"({"verdict": "effect", "missing": ["guide_root_compliance"], "candidates": [
      {"effect": "guide_root_compliance", "site": "all legs", "probability": 0.99,
       "parameters": [{"name": "stiffness_Nmm_per_rad", "value": )" +
                              std::to_string(value) + R"(, "low95": 9e5, "high95": 1.1e6}],
       "rmse_mm": 0.002, "held_out_rmse_mm": 0.002, "chi2_per_dof": 1.0}],
      "indistinguishable": [], "baseline": {"rmse_mm": 0.19, "held_out_rmse_mm": 0.19, "chi2_per_dof": 300},
      "final": {"rmse_mm": 0.002, "held_out_rmse_mm": 0.002, "chi2_per_dof": 1.0}, "noise_floor_mm": 0.002,
      "unexplained": {"significant": false, "share_of_misfit": 0, "pattern": ""}})");
  };
  const std::string device = "haptic-6psu-ideal-joints";
  for (const auto& [name, value] : {std::pair{"stiff.yaml", 4e6}, {"right.yaml", 1e6}}) {
    const test::Run run = test::deflect("add " + device + " --from " + diagnosis(value) + " -o " + path(name));
    ASSERT_EQ(run.code, 0) << run.out;
  }
  const test::Run run = history(device + " " + path("stiff.yaml") + " " + path("right.yaml"));
  ASSERT_EQ(run.code, 0) << run.out;

  const json j = json::parse(contents(folder / "history.json"));
  ASSERT_EQ(j["versions"].size(), 3u);
  const json first = j["versions"][0], half = j["versions"][1], last = j["versions"][2];
  EXPECT_EQ(first["device"], device);
  EXPECT_EQ(half["device"], "stiff");
  EXPECT_EQ(last["device"], "right");
  for (const char* error : {"rmse_mm", "held_out_rmse_mm", "chi2_per_dof"}) {
    EXPECT_GT(first[error].get<double>(), 1.1 * half[error].get<double>()) << error;
    EXPECT_GT(half[error].get<double>(), 1.1 * last[error].get<double>()) << error;
  }
  EXPECT_GT(first["rmse_mm"].get<double>(), 0.05);
  EXPECT_LT(last["rmse_mm"].get<double>(), 2 * last["noise_floor_mm"].get<double>());
  EXPECT_FALSE(first["patterns"].empty());
  for (const char* key : {"failing_tests", "strained_tolerances"}) EXPECT_TRUE(last[key].is_array()) << key;

  const std::string& text = run.out;
  EXPECT_NE(text.find("data.csv: 27 readings at 9 poses"), std::string::npos) << text;
  EXPECT_LT(text.find("\n" + device + " "), text.find("\nstiff "));
  EXPECT_LT(text.find("\nstiff "), text.find("\nright "));
  const std::string table = contents(folder / "out" / "history.csv");
  EXPECT_TRUE(table.starts_with("device,rmse_um,placebo_rmse_um,held_out_rmse_um,")) << table;
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4);
  const std::string svg = contents(folder / "out" / "history.svg");
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  EXPECT_NE(svg.find("noise and tolerances"), std::string::npos);
  EXPECT_TRUE(contents(folder / "out" / "history.pdf").starts_with("%PDF"));
  EXPECT_TRUE(contents(folder / "out" / "history.png").starts_with("\x89PNG"));
}

TEST_F(HistoryProgram, ThreadsDoNotChangeADigit) {
  simulate();
  ASSERT_EQ(history("haptic-6psu-ideal-joints --threads 1").code, 0);
  const std::string one = contents(folder / "history.json");
  ASSERT_EQ(history("haptic-6psu-ideal-joints --threads 3").code, 0);
  EXPECT_EQ(contents(folder / "history.json"), one);
}

TEST_F(HistoryProgram, SigmaIsTakenWhereTheFileHasNone) {
  simulate();
  std::istringstream in(contents(folder / "data.csv"));
  std::string bare, line;
  while (std::getline(in, line)) bare += line.substr(0, line.rfind(',')) + "\n";
  file("data.csv", bare);
  ASSERT_EQ(history("haptic-6psu-ideal-joints --sigma 0.002").code, 0);
  const json fine = json::parse(contents(folder / "history.json"));
  ASSERT_EQ(history("haptic-6psu-ideal-joints --sigma 0.02").code, 0);
  const json rough = json::parse(contents(folder / "history.json"));
  EXPECT_GT(fine["versions"][0]["chi2_per_dof"].get<double>(), 3 * rough["versions"][0]["chi2_per_dof"].get<double>());
}

TEST_F(HistoryProgram, RefusesWhatItCannotReadAndWritesNothing) {
  simulate();
  const std::string device = "haptic-6psu-ideal-joints";
  expect_refused(device + " haptic-6ps", "did you mean 'haptic-6psu'?");
  expect_refused(device + " " + path("none.yaml"), "none.yaml: cannot be read");
  expect_refused(device + " " + file("bad.yaml", "name: bad\nkinematik: {}\n"), "bad.yaml:2: kinematik: unknown key");
  expect_refused("", "devices is required");
  expect_refused(device + " --sigma 0", "a standard deviation above zero, in mm");
  expect_refused(device + " --threads 0.5", "--threads 0.5: give a whole number");
  expect_refused(device + " tripteron", "data.csv:2: ", 3);
  file("data.csv", contents(folder / "data.csv") + "9,x\n");
  expect_refused(device, "data.csv:29: ");
}

}  // namespace
}  // namespace deflect
