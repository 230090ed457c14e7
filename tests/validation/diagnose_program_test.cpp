// `deflect diagnose` as a user meets it: the contract's result, refusals, and the loop to a device whose error has
// fallen.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/csv_columns.h"
#include "tests/support/program.h"

namespace deflect {
namespace {

using nlohmann::json;
using test::contents;

class DiagnoseProgram : public ::testing::Test {
 protected:
  std::string path(const std::string& name) { return "'" + (folder / name).string() + "'"; }
  test::Run simulated(const std::string& arguments) {
    return test::deflect("simulate " + device + " " + arguments + " -o " + path("data.csv"));
  }
  test::Run diagnose(const std::string& more = "") {
    return test::deflect("diagnose " + device + " " + path("data.csv") + " --json " + path("d.json") + " " + more);
  }

  const std::string device = "haptic-6psu-ideal-joints";
  test::Folder folder;
};

TEST_F(DiagnoseProgram, SaysWhatIsMissingAddsItAndTheErrorFallsWhereAPlaceboDoesNothing) {
  ASSERT_EQ(simulated("--campaign random --with leg_defect,factor=0.5,leg=2 --seed 4").code, 0);
  const test::Run run = diagnose();
  ASSERT_EQ(run.code, 0) << run.out;
  EXPECT_NE(run.out.find("Missing: "), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("leg_defect (leg 2)"), std::string::npos) << run.out;
  const json d = json::parse(contents(folder / "d.json"));
  EXPECT_EQ(d["verdict"], "effect");
  EXPECT_EQ(d["missing"], json::array({"leg_defect"}));
  EXPECT_EQ(d["candidates"][0]["site"], "leg 2");
  double sum = d["probability_nothing"].get<double>() + d["probability_unknown"].get<double>();
  double before = 1;
  for (const json& c : d["candidates"]) {
    sum += c["probability"].get<double>();
    EXPECT_LE(c["probability"].get<double>(), before);
    before = c["probability"].get<double>();
    for (const json& p : c["parameters"]) EXPECT_LE(p["low95"], p["high95"]);
  }
  EXPECT_NEAR(sum, 1, 1e-9);
  for (const char* key : {"indistinguishable", "baseline", "final", "noise_floor_mm", "unexplained"})
    EXPECT_TRUE(d.contains(key)) << key;

  ASSERT_EQ(test::deflect("add " + device + " --from " + path("d.json") + " -o " + path("new.yaml")).code, 0);
  ASSERT_EQ(
      test::deflect("history " + path("data.csv") + " " + device + " " + path("new.yaml") + " --json " + path("h.json"))
          .code,
      0);
  const json versions = json::parse(contents(folder / "h.json"))["versions"];
  const double old_rmse = versions[0]["rmse_mm"], new_rmse = versions[1]["rmse_mm"],
               placebo = versions[1]["placebo_rmse_mm"];
  EXPECT_LT(new_rmse, 0.25 * old_rmse);
  EXPECT_GT(placebo, 0.85 * old_rmse);
  EXPECT_LT(versions[1]["held_out_rmse_mm"], 1.1 * versions[1]["noise_floor_mm"].get<double>());
  EXPECT_TRUE(versions[1]["patterns"].empty());
}

TEST_F(DiagnoseProgram, RefusesWhatItCannotUse) {
  EXPECT_EQ(diagnose().code, 2);
  std::ofstream(folder / "data.csv") << "pose,x_mm\n1,2\n";
  const test::Run run = diagnose();
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.out.find("data.csv:1"), std::string::npos) << run.out;
  ASSERT_EQ(simulated("--campaign paper --seed 1").code, 0);
  for (const char* wrong : {"--sigma 0", "--sigma nan", "--threads -1", "--bootstrap 5", "--effects nowhere.yaml"})
    EXPECT_EQ(diagnose(wrong).code, 2) << wrong;
  EXPECT_FALSE(std::filesystem::exists(folder / "d.json"));
}

TEST_F(DiagnoseProgram, RotationsAloneAreNotCalledMicrometres) {
  ASSERT_EQ(
      simulated("--campaign paper --noise-rotation 1e-5 --with guide_root_compliance,stiffness_Nmm_per_rad=1e6").code,
      0);
  const std::string text = contents(folder / "data.csv");
  std::ofstream(folder / "data.csv") << test::columns(
      text, {"pose", "x_mm", "y_mm", "z_mm", "roll_deg", "pitch_deg", "yaw_deg", "fx_N", "fy_N", "fz_N", "thx_rad",
             "thy_rad", "sigma_th_rad"});
  const test::Run run = diagnose();
  ASSERT_EQ(run.code, 0) << run.out;
  EXPECT_NE(run.out.find("rms µrad"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("rms µm"), std::string::npos) << run.out;
  const json d = json::parse(contents(folder / "d.json"));
  EXPECT_EQ(d["unit"], "mrad");
  EXPECT_NEAR(d["noise_floor_mm"].get<double>(), 1e-2, 1e-9);
  EXPECT_GT(d["baseline"]["rmse_mm"].get<double>(), 2 * d["noise_floor_mm"].get<double>());
}

TEST_F(DiagnoseProgram, IsSilentAboutItsProgressInAPipe) {
  ASSERT_EQ(simulated("--campaign paper --seed 1").code, 0);
  const test::Run run = diagnose();
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.out.find('\r'), std::string::npos);
  EXPECT_EQ(run.out.find(" s left"), std::string::npos);
}

}  // namespace
}  // namespace deflect
