// `fit`, `predict` and `compare --validation` as a user runs them.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/program.h"

namespace deflect {
namespace {

namespace fs = std::filesystem;

class FitProgram : public ::testing::Test {
 protected:
  /// An arm with a softer second joint, measured at nine poses.
  void measure() const {
    ASSERT_EQ(run("add arm factor@joint_2.rz --set factor=0.8 -o " + file("soft.yaml")).code, 0);
    ASSERT_EQ(run("simulate " + file("soft.yaml") + " --campaign paper --seed 1 -o " + file("first.csv")).code, 0);
  }
  /// The same arm again, at twenty other poses.
  void measure_again() const {
    ASSERT_EQ(run("simulate " + file("soft.yaml") + " --campaign random --seed 2 -o " + file("second.csv")).code, 0);
  }
  test::Run fit(const std::string& more = "") const {
    return run("fit arm " + file("first.csv") + " --free leg.joint_2.rz.stiffness -o " + file("fitted.yaml") +
               " --json " + file("fit.json") + " " + more);
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  static test::Run run(const std::string& arguments) { return test::deflect(arguments); }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(test::contents(file(name))); }

 private:
  test::Folder folder_;
};

TEST_F(FitProgram, FitsPredictsAndValidatesOneAfterTheOther) {
  measure();
  measure_again();
  const test::Run fitted = fit("--out " + file("tables"));
  ASSERT_EQ(fitted.code, 0) << fitted.out;
  EXPECT_TRUE(fitted.out.starts_with(test::contents(file("tables") + "/fit.txt")));
  EXPECT_TRUE(test::contents(file("tables") + "/parameters.csv")
                  .starts_with("path,unit,value,low95,high95,before\n\"leg.joint_2.rz.stiffness\",\"Nm/rad\","));
  const nlohmann::json parameter = json("fit.json")["parameters"][0];
  EXPECT_EQ(parameter["unit"], "Nm/rad");  // as the file has it
  EXPECT_EQ(parameter["before"], 4e4);
  EXPECT_LT(parameter["low95"], 3.2e4);
  EXPECT_GT(parameter["high95"], 3.2e4);
  EXPECT_NE(test::contents(file("fitted.yaml")).find("# arm fitted to"), std::string::npos);

  const test::Run predicted = run("predict " + file("fitted.yaml") + " --plan " + file("second.csv") + " --fit " +
                                  file("fit.json") + " --json " + file("predicted.json") + " --out " + file("out"));
  ASSERT_EQ(predicted.code, 0) << predicted.out;
  EXPECT_EQ(predicted.out.find("note: "), std::string::npos) << "it is the fitted one: " << predicted.out;
  EXPECT_EQ(json("predicted.json")["numbers"].size(), 280u * 6);
  EXPECT_TRUE(fs::exists(file("out") + "/predicted.csv"));

  const test::Run valid =
      run("compare " + file("fitted.yaml") + " " + file("second.csv") + " --validation --fit " + file("fit.json") +
          " --calibration " + file("first.csv") + " --use " + file("first.csv") + " --json " + file("valid.json"));
  ASSERT_EQ(valid.code, 0) << valid.out;
  const nlohmann::json validity = json("valid.json");
  EXPECT_TRUE(validity["agrees"]) << valid.out;
  EXPECT_EQ(validity["calibration"]["readings"], 27);
  EXPECT_EQ(validity["use"]["points"].size(), 27u);
  EXPECT_EQ(validity["maturity"].size(), 14u);
  const test::Run with_its_own =
      run("compare " + file("fitted.yaml") + " " + file("first.csv") + " --validation --fit " + file("fit.json"));
  EXPECT_EQ(with_its_own.code, 2);
  EXPECT_NE(with_its_own.out.find("what a model was fitted to cannot validate it"), std::string::npos)
      << with_its_own.out;
  // The arm as it was is a fifth too stiff in one joint.
  const test::Run before = run("compare arm " + file("second.csv") + " --validation --json " + file("before.json"));
  ASSERT_EQ(before.code, 0);
  EXPECT_FALSE(json("before.json")["agrees"]);
}

TEST_F(FitProgram, RefusesWithTheRemedy) {
  measure();
  const std::string data = file("first.csv"), same = file("same.csv");
  fs::copy_file(data, same);
  const std::pair<std::string, const char*> refused[] = {
      {"compare arm " + data + " --validation --calibration " + data, "cannot validate it"},
      {"compare arm " + data + " --validation --calibration " + same, "cannot validate it"},
      {"compare arm " + data + " --use " + data, "goes with --validation"},
      {"fit arm " + data + " --free leg.joint_9.rz.stiffness -o " + file("x.yaml"), "joint_2"},
      {"fit arm " + data + " --free leg.joint_2.rz.stiffness -o " + data, "this is an input file"},
      {"predict arm", "--at POSE"},
      {"predict arm --at 1,2,3 --plan " + data, "--plan"},
      {"predict truss-45 --at donw=1", "did you mean 'down'"},
      {"predict truss-45 --at down=1,side=2,down=2",
       "--at 'down=1,side=2,down=2': 'down' is given twice: write the factor of a load case once"},
      {"predict truss-45 --at down=much", "--at 'down=much'"},
      {"predict arm --plan " + data + " --fit " + data, "fit --json"},
  };
  for (const auto& [arguments, words] : refused) {
    const test::Run run = test::deflect(arguments);
    EXPECT_EQ(run.code, 2) << arguments << run.out;
    EXPECT_NE(run.out.find(words), std::string::npos) << arguments << "\n" << run.out;
  }
  EXPECT_FALSE(fs::exists(file("x.yaml")));
}

// solve is linear: a reader who compares both is told why they differ.
TEST_F(FitProgram, PredictSaysInWhichGeometryAndWhatItTakesFromIt) {
  const std::string help = run("predict --help").out;
  for (const char* words : {"deformed shape", "'solve' is linear", "a fifth"})
    EXPECT_NE(help.find(words), std::string::npos) << words << "\n" << help;
  const std::string at = " --load 50,0,0 --json " + file("at.json");
  ASSERT_EQ(run("predict haptic-6psu --at 25,25,198.9 --sigma 0.002 --sigma-rotation 1e-5" + at).code, 0);
  const auto uz = json("at.json")["numbers"][2];
  ASSERT_EQ(run("solve haptic-6psu --pose 25,25,198.9 --geometry finite" + at).code, 0);
  const double finite = json("at.json")["analytic"]["displacement"][2];
  EXPECT_NEAR(uz["value"], finite, 1e-6);
  ASSERT_EQ(run("solve haptic-6psu --pose 25,25,198.9" + at).code, 0);
  const double linear = json("at.json")["analytic"]["displacement"][2];
  EXPECT_GT(uz["deviation"]["tolerances"], 0.2 * std::abs(finite - linear));
  ASSERT_EQ(run("predict haptic-6psu --joints 90,90,90,90,90,90 --sigma 0.002 --sigma-rotation 1e-5" + at).code, 0);
  EXPECT_EQ(json("at.json")["plan"], "--joints");
}

TEST_F(FitProgram, AFrameIsPredictedUnderFactorsOnItsLoadCases) {
  const test::Run one = run("predict truss-45 --at down=1,side=-0.5 --json " + file("one.json"));
  ASSERT_EQ(one.code, 0) << one.out;
  const nlohmann::json result = json("one.json");
  for (const nlohmann::json& n : result["numbers"]) {
    EXPECT_FALSE(n.contains("analytic"));
    EXPECT_LE(n["low95"], n["value"]);
  }
}

TEST_F(FitProgram, ThePageOfAValidationPrints) {
  measure();
  const std::string page = file("page.html"), pdf = file("page.pdf");
  const test::Run run = test::deflect("compare arm " + file("first.csv") + " --validation --report " + page);
  if (run.code == 2 && run.out.find("built without pages") != std::string::npos) GTEST_SKIP() << run.out;
  ASSERT_EQ(run.code, 0) << run.out;
  EXPECT_NE(test::contents(page).find("NASA-STD-7009"), std::string::npos);
  if (test::command("chromium-headless-shell --version").code != 0) GTEST_SKIP() << "no chromium-headless-shell";
  const test::Run printed = test::command(
      "chromium-headless-shell --no-sandbox --disable-gpu --virtual-time-budget=20000 "
      "--print-to-pdf='" +
      pdf + "' 'file://" + page + "'");
  ASSERT_EQ(printed.code, 0) << printed.out;
  EXPECT_EQ(test::contents(pdf).substr(0, 5), "%PDF-");
  EXPECT_GT(fs::file_size(pdf), 50'000u);
}

}  // namespace
}  // namespace deflect
