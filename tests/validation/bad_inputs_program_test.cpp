// Inputs of a new user that are not what they should be, as the program answers them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "msa/base/files.h"
#include "tests/support/measurements.h"
#include "tests/support/program.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/page/page.h"
#include "validation/report/diagnosis_results.h"

namespace deflect {
namespace {

using namespace diagnosis;
using namespace page;
using namespace report;

class BadInputs : public ::testing::Test {
 protected:
  std::string path(const std::string& name) { return "'" + (folder / name).string() + "'"; }
  std::string write(const std::string& name, const std::string& text) {
    write_text(folder / name, text);
    return path(name);
  }
  void expect(const std::string& arguments, int code, const std::string& says) {
    const test::Run run = test::deflect(arguments);
    EXPECT_EQ(run.code, code) << arguments << "\n" << run.out;
    EXPECT_NE(run.out.find(says), std::string::npos) << arguments << "\n" << run.out;
    EXPECT_EQ(run.out.find("a bug"), std::string::npos) << run.out;
  }

  test::Folder folder;
  const std::string device = "haptic-6psu-ideal-joints";
};

TEST_F(BadInputs, ResultsThatAreNone) {
  if (!pages_are_built()) GTEST_SKIP() << "built without pages";
  for (const std::string text : {"", "{", "[]", "null", "3", "NaN", "{}", "\"x\"", "\xFF\xFE\x00"})
    expect("report " + write("result.json", text) + " -o " + path("page.html"), 2, "result.json");
  expect("report " + write("result.json", std::string(100000, '[')) + " -o " + path("page.html"), 2,
         "nested more than");
  Diagnosis d;
  d.device = "another";
  expect("report " + write("result.json", diagnosis_json(d)) + " --device " + device + " --data " +
             write("data.csv",
                   test::usual_file("a,0,0,173.9,0,0,0,50,0,0,0.1,0,0\na,0,0,173.9,0,0,0,0,50,0,0,0.1,0\n", "")) +
             " --sigma 0.002 -o " + path("page.html"),
         2, "this diagnosis is of 'another', but --device is 'haptic-6psu-ideal-joints'");
  EXPECT_FALSE(std::filesystem::exists(folder / "page.html"));
}

TEST_F(BadInputs, ADeviceIsNotWrittenOverWithoutAWord) {
  const std::string mine = write("mine.yaml", test::deflect("devices " + device).out);
  const std::string add = "add " + mine + " modulus --set factor=0.9 -o " + mine;
  expect(add, 2, "this is an input file: name another, or overwrite it with --force");
  expect(add + " --force", 0, "modulus");
}

TEST_F(BadInputs, ASessionGivenTwiceIsNoReplicate) {
  const std::string data = path("data.csv"), copy = path("copy.csv");
  expect("simulate " + device + " --campaign paper --seed 1 -o " + data, 0, "27 readings");
  ASSERT_EQ(test::command("cp " + data + " " + copy).code, 0);
  for (const std::string& again : {data, copy})
    expect("diagnose " + device + " " + data + " " + again + " --bootstrap 99", 2, "these are the readings of");
}

TEST_F(BadInputs, TheSameMachineTwiceIsSaid) {
  const std::string data = path("data.csv");
  expect("simulate " + device + " --campaign paper --geometry linear -o " + data, 0, "27 readings");
  expect("history " + data + " " + device + " " + device, 0,
         "versions 1 (" + device + ") and 2 (" + device + ") are the same machine");
}

TEST_F(BadInputs, LoadsBeyondWhatTheMachineCarries) {
  expect("simulate " + device + " --campaign paper --elements 1 --force 1e6 -o " + path("data.csv"), 4,
         "of the machine as drawn equilibria are found up to");
}

TEST_F(BadInputs, MeasurementsThatSayNothing) {
  const std::string pose = "a,0,0,173.9,0,0,0,";
  const auto compared = [&](const std::string& text) {
    return "compare " + device + " --sigma 0.002 " + write("data.csv", text);
  };
  expect(compared(test::usual_file(pose + "50,0,0,0.1,0,0\n" + pose + "0,50,0,0,0.1,0\n")), 0,
         "too few to conclude anything");
  expect(compared(pose + "50,0,0,0.1,0,0\n" + pose + "0,50,0,0,0.1,0\n"), 2, "data.csv:1: there is no header");
  expect(compared(test::usual_file(pose + "50,0,0,0.1,0,0\n" + pose + "0,50,0,0,1e300,0\n")), 2,
         "data.csv:3: column 'uy_mm': 1e300 is out of all proportion");
  expect(compared("PK\x03\x04"), 2, "save its sheet as CSV");
}

TEST_F(BadInputs, AMistakeOfRecordingIsTheFirstThingADiagnosisSays) {
  const std::string data = path("data.csv");
  expect("simulate " + device + " --campaign random --geometry linear -o " + data, 0, "280 readings");
  std::string text = read_text(folder / "data.csv");
  text.replace(text.find("ux_mm,uy_mm,uz_mm"), 17, "uy_mm,ux_mm,uz_mm");
  write("data.csv", text);
  const std::string json = path("diagnosis.json");
  expect("diagnose " + device + " " + data + " --json " + json, 0,
         "Before anything else: these data look like displacements that stand in other axes (recorded x = y, y = x, z "
         "= z)");
  const nlohmann::json result = nlohmann::json::parse(read_text(folder / "diagnosis.json"));
  EXPECT_EQ(result.at("verdict"), "unknown_effect");
  EXPECT_EQ(result.at("missing"), nlohmann::json::array());
  EXPECT_TRUE(result.at("mistakes").at(0).at("certain"));
  if (pages_are_built()) expect("report " + json + " -o " + path("page.html"), 0, "Report:");
}

}  // namespace
}  // namespace deflect
