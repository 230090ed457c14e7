// `deflect check` as a user meets it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.h"
#include "tests/support/stiffnesses.h"

namespace deflect {
namespace {

using nlohmann::json;

class CheckProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    std::mt19937 random(1);
    K = test::random_stiffness(random);
    write("K.csv", K, 6);
    write("negative.csv", -K, 6);
  }
  void write(const std::string& name, const MatrixX& m, int digits) {
    std::ofstream(folder / name) << test::printed(m, digits);
  }
  test::Run check(const std::string& arguments) {
    return test::deflect(fmt::format("check {} --json '{}'", arguments, (folder / "r.json").string()));
  }
  std::string file(const std::string& name) { return "'" + (folder / name).string() + "'"; }
  json result() { return json::parse(test::contents(folder / "r.json")); }

  test::Folder folder;
  Matrix6 K;
};

TEST_F(CheckProgram, ARightMatrixPassesWithItsStructure) {
  const test::Run run = check(file("K.csv") + " --out " + file("out"));
  ASSERT_EQ(run.code, 0) << run.out;
  EXPECT_NE(run.out.find("K.csv passes: it is symmetric and positive and holds every direction."), std::string::npos);
  EXPECT_NE(run.out.find("One matrix cannot show another point"), std::string::npos);
  const json r = result();
  EXPECT_EQ(r["passes"], true);
  EXPECT_TRUE(r["diagnosis"].empty());
  EXPECT_EQ(r["checks"].size(), 5u);
  for (const json& c : r["checks"]) EXPECT_EQ(c["passes"], true) << c;
  EXPECT_EQ(r["eigenvalues_N_per_mm"].size(), 6u);
  for (const char* name : {"centre_of_stiffness_mm", "centre_of_compliance_mm", "principal_translation_N_per_mm",
                           "principal_axes", "principal_rotation_Nmm_per_rad"})
    EXPECT_EQ(r[name].size(), 3u) << name;
  EXPECT_LT(r["max_asymmetry"].get<double>(), 1e-5);
  EXPECT_EQ(test::contents(folder / "out" / "check.txt"), run.out);
  for (const char* name : {"checks.csv", "structure.csv"})
    EXPECT_GT(test::contents(folder / "out" / name).size(), 100u) << name;
}

TEST_F(CheckProgram, AFailedCheckIsExitCode4WithDiagnosisAndFiles) {
  const test::Run run = check(file("negative.csv") + " --reference " + file("K.csv"));
  EXPECT_EQ(run.code, 4);
  EXPECT_NE(run.out.find("fails: its sign is reversed"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("Remedy: take −K"), std::string::npos);
  const json r = result();
  EXPECT_EQ(r["passes"], false);
  ASSERT_EQ(r["diagnosis"].size(), 1u);
  EXPECT_EQ(r["diagnosis"][0]["id"], "negated");
  EXPECT_EQ(r["diagnosis"][0]["certain"], true);
  EXPECT_FALSE(r.contains("centre_of_stiffness_mm"));
}

TEST_F(CheckProgram, TheReferenceCanBeADeviceAtAPose) {
  const std::string device = " --device haptic-6psu-ideal-joints --pose 10,-5,180,3,-2,4";
  const std::string result_file = file("s.json");
  ASSERT_EQ(test::deflect("solve haptic-6psu-ideal-joints --pose 10,-5,180,3,-2,4 --json " + result_file).code, 0);
  for (const char* key : {"analytic.stiffness", "msa.stiffness"})
    EXPECT_EQ(check(result_file + " --key " + key + device).code, 0);
  EXPECT_EQ(check(result_file + " --unit m --order rotation-first" + device).code, 0);
  const test::Run other = check(result_file + " --device haptic-6psu-ideal-joints --pose 10,-5,190");
  EXPECT_EQ(other.code, 4);
  EXPECT_EQ(result()["diagnosis"][0]["id"], "stiffer");
  EXPECT_GT(result()["ratio_to_reference"][0].get<double>(), 1);
}

// Contacts are as stiff as their load makes them: the result says under which it was computed.
TEST_F(CheckProgram, TheLoadOfAResultIsTakenForTheDevice) {
  const std::string at = "haptic-6psu --pose 10,-5,180";
  ASSERT_EQ(test::deflect("solve " + at + " --load 30,0,20 --json " + file("solved.json")).code, 0);
  const test::Run same = check(file("solved.json") + " --device " + at);
  EXPECT_EQ(same.code, 0) << same.out;
  EXPECT_NE(same.out.find("under the load 30,0,20,0,0,0"), std::string::npos) << same.out;
  EXPECT_EQ(check(file("solved.json") + " --device " + at + " --load 300,0,0").code, 4);
}

TEST_F(CheckProgram, OrderUnitAndPassiveJointsAreOptions) {
  const Matrix6 P = test::halves_exchanged();
  write("swapped.csv", P * K * P, 6);
  EXPECT_EQ(check(file("swapped.csv") + " --order rotation-first").code, 0);
  Vector6 t;
  t << 0, 0, 0, 0, 0, 1;
  write("leg.csv", K - K * t * t.transpose() * K / t.dot(K * t), 15);
  write("J.csv", t.transpose(), 3);
  EXPECT_EQ(check(file("leg.csv")).code, 4);
  EXPECT_EQ(result()["diagnosis"][0]["id"], "free_direction");
  EXPECT_EQ(check(file("leg.csv") + " --passive " + file("J.csv")).code, 0);
  EXPECT_EQ(check(file("K.csv") + " --passive " + file("J.csv")).code, 4);
  EXPECT_EQ(result()["diagnosis"][0]["id"], "passive_joint_resists");
}

TEST_F(CheckProgram, BadInputIsExitCode2AndLeavesNoFile) {
  std::ofstream(folder / "nan.csv") << "1,2,3\n4,nan,6\n";
  const std::pair<std::string, std::string> cases[] = {
      {file("none.csv"), "none.csv: cannot be read"},
      {file("nan.csv"), "nan.csv:2: column 2: 'nan' is not a finite number"},
      {file("K.csv") + " --unit cm", "--unit 'cm': write mm or m"},
      {file("K.csv") + " --order mixed", "--order 'mixed'"},
      {file("K.csv") + " --tolerance -1", "--tolerance -1"},
      {file("K.csv") + " --size 200", "--size: '200' has no unit"},
      {file("K.csv") + " --pose 0,0,170", "belong to --device"},
      {file("K.csv") + " --device haptic-6psu-ideal-joints", "--pose"},
      {file("K.csv") + " --device haptic-6psu --pose 0,0,170", "give --load"},
      {file("K.csv") + " --reference " + file("K.csv") + " --device haptic-6psu --pose 0,0,170", "either --reference"},
      {file("K.csv") + " --reference " + file("negative.csv"), "the reference is not symmetric and positive"},
  };
  for (const auto& [arguments, says] : cases) {
    const test::Run run = check(arguments);
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_NE(run.out.find(says), std::string::npos) << run.out;
    EXPECT_FALSE(std::filesystem::exists(folder / "r.json"));
  }
}

TEST_F(CheckProgram, HelpExplainsItselfWithAnExample) {
  const test::Run run = test::deflect("check --help");
  EXPECT_EQ(run.code, 0);
  EXPECT_NE(run.out.find("Example:\n  deflect check"), std::string::npos);
}

}  // namespace
}  // namespace deflect
