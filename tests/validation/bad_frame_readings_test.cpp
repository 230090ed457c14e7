// What is refused, or read, in files of machines (measurements_test.cpp, bad_inputs_program_test.cpp) in files of
// frames: headers, cells, numbers out of proportion, results and descriptions that do not go together.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/frame/file/frame_file.h"
#include "tests/support/paths.h"
#include "tests/support/program.h"
#include "validation/subject/subject.h"

namespace deflect {
namespace {

using namespace measurement;
using subject::Subject;

Subject portal() {
  return frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames/portal-semi-rigid.yaml");
}

std::string refusal(const std::string& csv) {
  static const Subject s = portal();
  try {
    s.placed(parse_measurements(csv, "data.csv", s.instruments()));
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

struct Bad {
  std::string text, begins, says;
};

void expect_refused(const std::vector<Bad>& files) {
  for (const Bad& bad : files) {
    const std::string said = refusal(bad.text);
    EXPECT_TRUE(said.starts_with("data.csv:" + bad.begins)) << bad.text.substr(0, 200) << "\n" << said;
    EXPECT_NE(said.find(bad.says), std::string::npos) << bad.text.substr(0, 200) << "\n" << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  }
}

const std::string header = "load.side,top_x_mm,turn_C_rad", row = "1,2,0.003";

TEST(BadFrameReadings, HeadersAreRefusedWithRemedy) {
  const auto with = [](const std::string& more) { return header + "," + more + "\n" + row + ",1\n"; };
  expect_refused({
      {"", "1: ", "empty"},
      {header + "\n", "1: ", "no row below"},
      {with("top_x_mm"), "1: column 'top_x_mm' stands twice", "remove or rename one"},
      {with("top_x_um"), "1: columns 'top_x_mm' and 'top_x_um' are both", "keep one"},
      {with("top_x"), "1: ", "top_x_mm"},
      {with("mid_z"), "1: unknown column 'mid_z'", "did you mean 'mid_z_mm'?"},
      {with("load.side"), "1: column 'load.side' stands twice", "remove or rename one"},
      {with("load.sid"), "1: unknown column 'load.sid'", "did you mean 'load.side'?"},
      {with("load.above_N"), "1: unknown column 'load.above_N'", "did you mean 'load.above'?"},
      {with("node.B.fx"), "1: unknown column 'node.B.fx'", "did you mean 'node.B.fx_N'?"},
      {with("node.B.fx_furlong"), "1: unknown column 'node.B.fx_furlong'", "did you mean 'node.B.fx_N'"},
      {with("node.X.fx_N"), "1: unknown column 'node.X.fx_N'", "did you mean 'node."},
      {with("sigma_u"), "1: unknown column 'sigma_u'", "did you mean 'sigma_u_mm'?"},
      {with("sequense"), "1: unknown column 'sequense'", "did you mean 'sequence'?"},
      {with("operator"), "1: unknown column 'operator'", "columns: "},
      {with("fx_N"), "1: unknown column 'fx_N'", ""},
      {with("x_mm"), "1: unknown column 'x_mm'", ""},
      {with(std::string(100000, 'x')), "1: unknown column 'xxx", "…"},
      {"0,1,2\n3,4,5\n", "1: there is no header", "write the names of the columns above it"},
      {"top_x_mm\n1\n", "1: ", "load.side"},
      {"load.side\n1\n", "1: ", "top_x_mm"},
  });
}

TEST(BadFrameReadings, CellsAreRefusedWithRemedy) {
  const auto second = [](const std::string& cells, const std::string& more = "") {
    return header + more + "\n" + row + (more.empty() ? "" : ",1") + "\n" + cells + "\n";
  };
  expect_refused({
      {second("1,x,1"), "3: column 'top_x_mm'", "'x' is not a finite number"},
      {second("1,inf,1"), "3: column 'top_x_mm'", "not a finite number"},
      {second("1,1e300,1"), "3: column 'top_x_mm': 1e300 is out of all proportion", "leave it empty"},
      {second("1e300,1,1"), "3: column 'load.side': 1e300 is out of all proportion", "correct"},
      {second("inf,1,1"), "3: column 'load.side'", "not a finite number"},
      {second("zero,1,1"), "3: column 'load.side'", "'zero' is not a finite number"},
      {second("1,1,1,1e300", ",node.B.fx_N"), "3: column 'node.B.fx_N': 1e300 is out of all proportion", "correct"},
      {second("1,1," + std::string(100000, '1') + "x"), "3: column 'turn_C_rad'", "…' is not"},
      {second("1,1"), "3: 2 cells where the header has 3", "cut short"},
      {second("1,1,1,"), "3: 4 cells where the header has 3", "separator at the end"},
      {second("1,1,5,1"), "3: 4 cells", "decimal commas need semicolons"},
      {second("1,1,1,0", ",sigma_u_mm"), "3: column 'sigma_u_mm': 0 is not positive", "leave"},
      {second("1,1,1,-2", ",sigma_u_mm"), "3: column 'sigma_u_mm': -2 is not positive", "leave"},
      {second("1,1,1,1.0", ",sequence"), "3: column 'sequence': 1.0 stands in line 2 too", "order"},
      {second("1,1,1,", ",sequence"), "3: column 'sequence': the cell is empty", "remove the column"},
      {second("1,1,1,-300", ",temperature_C"), "3: column 'temperature_C'", "absolute zero"},
      {"PK\x03\x04", "1: ", "save its sheet as CSV"},
  });
  EXPECT_EQ(refusal(second("1,2,0.003")), "") << "a row may stand twice: a replicate";
  EXPECT_EQ(refusal(header + "\n" + row + "\n"), "") << "one row";
}

class BadFramePrograms : public ::testing::Test {
 protected:
  std::string path(const std::string& name) { return "'" + (folder / name).string() + "'"; }
  void expect(const std::string& arguments, int code, const std::string& says) {
    const test::Run run = test::deflect(arguments);
    EXPECT_EQ(run.code, code) << arguments << "\n" << run.out;
    EXPECT_NE(run.out.find(says), std::string::npos) << arguments << "\n" << run.out;
    EXPECT_EQ(run.out.find("a bug"), std::string::npos) << run.out;
  }
  std::string write(const std::string& name, const std::string& text) {
    write_text(folder / name, text);
    return path(name);
  }

  test::Folder folder;
  const std::string frame = "portal-semi-rigid";
};

TEST_F(BadFramePrograms, ResultsAndReadingsOfAnotherFrame) {
  const std::string data = path("data.csv"), result = path("d.json");
  expect("simulate " + frame + " --campaign paper -o " + data, 0, "3 readings");
  expect("compare truss-45 " + data, 2,
         "data.csv:1: 7 of 9 columns are unknown ('load.above', 'load.twist', 'top_x_mm', 'turn_C_rad', "
         "'turn_B_rad', …): are these readings of something else? The columns are pose, ");
  expect("compare arm " + data, 2, "data.csv:1: ");
  expect("diagnose " + frame + " " + data + " --json " + result, 0, "");
  expect("report " + result + " --device truss-45 --data " + data + " -o " + path("page.html"), 2,
         "d.json: this diagnosis is of 'portal-semi-rigid', but --device is 'truss-45'");
  EXPECT_FALSE(std::filesystem::exists(folder / "page.html"));
  expect("add truss-45 --from " + result + " -o " + path("new.yaml"), 2, "");
}

TEST_F(BadFramePrograms, AFrameIsNotWrittenOverWithoutAWord) {
  const std::string mine =
      write("mine.yaml", test::contents(test::source_dir() + "/validation/frames/" + frame + ".yaml"));
  const std::string add = "add " + mine + " modulus --set factor=0.9 -o " + mine;
  expect(add, 2, "this is an input file: name another, or overwrite it with --force");
  expect(add + " --force", 0, "modulus");
}

TEST_F(BadFramePrograms, TheSameFrameTwiceIsSaid) {
  const std::string data = path("data.csv");
  expect("simulate " + frame + " --campaign paper -o " + data, 0, "3 readings");
  expect("history " + data + " " + frame + " " + frame, 0,
         "versions 1 (" + frame + ") and 2 (" + frame + ") are the same frame");
}

TEST_F(BadFramePrograms, ReadingsThatSayNothing) {
  const auto compared = [&](const std::string& text) { return "compare " + frame + " " + write("data.csv", text); };
  expect(compared(header + "\n" + row + "\n"), 2,
         "data.csv: one reading says nothing of a model: two or more are wanted");
  expect(compared(header + "\n" + row + "\n0.5,1,0.001\n"), 0, "too few");
  expect(compared(header + "\n" + row + "\n0.5,1e300,0\n"), 2,
         "data.csv:3: column 'top_x_mm': 1e300 is out of all proportion");
  expect(compared(header + "\n0,0,0\n0,0,0\n"), 0, "nothing was loaded");
}

TEST_F(BadFramePrograms, AMistakeOfRecordingIsTheFirstThingADiagnosisSays) {
  const std::string data = path("data.csv");
  expect("simulate " + frame + " --campaign random -o " + data, 0, "200 readings");
  std::string text = test::contents(folder / "data.csv");
  text.replace(text.find("top_x_mm,mid_z_mm"), 17, "mid_z_mm,top_x_mm");
  write("data.csv", text);
  expect("diagnose " + frame + " " + data, 0, "Before anything else: ");
}

}  // namespace
}  // namespace deflect
