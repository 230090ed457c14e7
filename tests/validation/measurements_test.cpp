#include "validation/measurement/measurements.h"

#include <gtest/gtest.h>

#include <chrono>

#include "tests/support/measurements.h"
#include "tests/support/program.h"

namespace deflect {
namespace {

using namespace measurement;

using test::refusal;
using test::usual_file;

TEST(Measurements, AreReadInSI) {
  const Measurements m = parse_measurements(
      "note,thz_rad,ux_mm,pose,sequence,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg,fx_N,fy_N,fz_N,mz_Nmm,"
      "sigma_u_mm,sigma_th_rad,temperature_C,note 2\n"
      "windy,1e-4,-0.11,corner,7,1,2,174,10,20,30,-50,4,3,250,0.002,1e-6,23.5,\n"
      ",,,corner,3,1,2.0,174,10,20,30,0,0,0,0,,,,b\n",
      "data.csv");
  EXPECT_EQ(m.origin, "data.csv");
  EXPECT_FALSE(m.by_joints());
  EXPECT_TRUE(m.temperature_recorded);
  EXPECT_EQ(m.note_columns, (std::vector<std::string>{"note", "note 2"}));
  ASSERT_EQ(m.poses.size(), 1u);
  EXPECT_EQ(m.poses[0].label, "corner");
  EXPECT_EQ(m.poses[0].pose_mm_deg, (Vector6() << 1, 2, 174, 10, 20, 30).finished());
  EXPECT_EQ(m.poses[0].readings, (std::vector<std::size_t>{0, 1}));
  ASSERT_EQ(m.readings.size(), 2u);
  const Reading& first = m.readings[0];
  EXPECT_EQ(first.load, (Vector6() << -50, 4, 3, 0, 0, 0.25).finished());
  EXPECT_EQ(first.displacement[0], -0.11e-3);
  EXPECT_EQ(first.displacement[5], 1e-4);
  for (const std::size_t without_column : {1u, 2u, 3u, 4u}) EXPECT_FALSE(first.displacement[without_column]);
  EXPECT_EQ(first.sigma_u, 2e-6);
  EXPECT_EQ(first.sigma_th, 1e-6);
  EXPECT_EQ(first.sequence, 7);
  EXPECT_EQ(first.temperature_C, 23.5);
  EXPECT_EQ(first.notes, (std::vector<std::string>{"windy", ""}));
  EXPECT_EQ(first.line, 2u);
  const Reading& second = m.readings[1];
  for (const auto& empty : second.displacement) EXPECT_FALSE(empty);
  EXPECT_FALSE(second.sigma_u || second.sigma_th);
  EXPECT_EQ(second.temperature_C, 20) << "the cell is empty";
  EXPECT_EQ(in_sequence(m, "friction"), (std::vector<std::size_t>{1, 0}));
}

TEST(Measurements, AreReadWithJointCoordinatesInAnyOrder) {
  const Measurements m = parse_measurements(
      "q2_mm,q1_rad,q3_rad,pose,fx_N,fy_N,fz_N,uz_mm\n"
      "-12.5,1,2,a,0,0,1,1\n"
      "-12.5,1,2,b,0,0,1,1\n"
      "-12.50,1,2,a,0,0,2,2\n",
      "data.csv");
  EXPECT_TRUE(m.by_joints());
  EXPECT_EQ(m.joint_rotates, (std::vector<bool>{true, false, true}));
  ASSERT_EQ(m.poses.size(), 2u);
  EXPECT_EQ(m.poses[0].joints, (VectorX(3) << 1, -0.0125, 2).finished());
  EXPECT_EQ(m.poses[0].readings, (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(m.poses[1].readings, (std::vector<std::size_t>{1}));
  EXPECT_FALSE(m.temperature_recorded);
  EXPECT_EQ(m.readings[2].temperature_C, 20);
  EXPECT_FALSE(m.readings[2].sequence);
}

TEST(Measurements, AreTheSameHoweverTheyWereSaved) {
  const std::string plain = usual_file("0,0,0,173.9,0,0,0,-50,0,0,-0.11,,1e-3\n");
  std::string crlf, semicolons, tabs, quoted;
  for (const char c : plain) {
    crlf += c == '\n' ? "\r\n" : std::string(1, c);
    semicolons += c == ',' ? ';' : c == '.' ? ',' : c;
    tabs += c == ',' ? '\t' : c;
    quoted += c == ',' ? "\",\"" : c == '\n' ? "\"\n\"" : std::string(1, c);
  }
  quoted = "\"" + quoted.substr(0, quoted.size() - 1);
  for (const std::string& text : {plain, crlf, semicolons, tabs, quoted, "\xEF\xBB\xBF" + plain, plain + "\n\r\n"}) {
    SCOPED_TRACE(text);
    EXPECT_EQ(measurements_text(parse_measurements(text, "data.csv")), plain.substr(0, plain.size() - 5) + "0.001\n");
  }
}

struct Bad {
  std::string text, begins, says;
};

void expect_refused(const std::vector<Bad>& files) {
  for (const Bad& bad : files) {
    const std::string said = refusal(bad.text);
    EXPECT_TRUE(said.starts_with("data.csv:" + bad.begins)) << bad.text << "\n" << said;
    EXPECT_NE(said.find(bad.says), std::string::npos) << bad.text << "\n" << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  }
}

TEST(Measurements, RefuseHeadersWithRemedy) {
  const std::string usual_row = "a,0,0,174,0,0,0,50,0,0,1,1,1";
  const auto with = [&](const std::string& more) { return usual_file(usual_row + ",1\n", "," + more); };
  expect_refused({
      {"", "1: ", "empty"},
      {usual_file(""), "1: ", "no row below"},
      {with("ux_mm"), "1: column 'ux_mm' stands twice", "remove or rename one"},
      {with("thx"), "1: unknown column 'thx'", "the unit is missing, did you mean 'thx_rad'?"},
      {with("sigma_u"), "1: unknown column 'sigma_u'", "did you mean 'sigma_u_mm'?"},
      {with("sequense"), "1: unknown column 'sequense'", "did you mean 'sequence'?"},
      {with("temp_C"), "1: unknown column 'temp_C'", "did you mean 'temperature_C'?"},
      {with("operator"), "1: unknown column 'operator'", "columns: pose, x_mm"},
      {with("q1"), "1: unknown column 'q1'", "did you mean 'q1_rad'?"},
      {with("q3_deg"), "1: columns 'x_mm' and 'q3_deg'", "keep one of the two"},
      {with("thx_furlong"), "1: unknown column 'thx_furlong'", "did you mean 'thx_rad', with its numbers in rad?"},
      {with("FX_MN"), "1: unknown column 'FX_MN'", "did you mean 'fx_N'"},
      {with("ux_um"), "1: columns 'ux_mm' and 'ux_um' are both ux_mm", "keep one"},
      {"0,1,2\n3,4,5\n", "1: there is no header", "write the names of the columns above it"},
      {with("q01_rad"), "1: unknown column 'q01_rad'", "did you mean 'q1_rad'?"},
      {with("q0_rad"), "1: unknown column 'q0_rad'", "did you mean 'q1_rad'?"},
      {with("q99999999999999999999_rad"), "1: unknown column", "q9999"},
      {with(std::string(100000, 'x')), "1: unknown column 'xxx", "…"},
      {with("q1_rad"), "1: columns 'x_mm' and 'q1_rad'", "keep one of the two"},
      {"pose,x_mm,q1_rad,fx_N,fy_N,fz_N,ux_mm\na,1,1,1,1,1,1\n", "1: columns 'x_mm' and 'q1_rad'", "keep one"},
      {"pose,q1_rad,q3_rad,fx_N,fy_N,fz_N,ux_mm\na,1,1,1,1,1,1\n", "1: column 'q3_rad'", "coordinate 2"},
      {"pose,q2_rad,fx_N,fy_N,fz_N,ux_mm\na,1,1,1,1,1\n", "1: column 'q2_rad'", "numbered from 1 without gaps"},
      {"pose,q1_rad,q1_mm,fx_N,fy_N,fz_N,ux_mm\na,1,1,1,1,1,1\n", "1: columns 'q1_rad' and 'q1_mm'", "keep one"},
      {"pose,fx_N,fy_N,fz_N,ux_mm\na,1,1,1,1\n", "1: the commanded pose is missing", "q1_rad"},
      {"pose,x_mm,y_mm,z_mm,fx_N,fy_N,fz_N,ux_mm\na,1,1,1,1,1,1,1\n",
       "1: columns missing: roll_deg, pitch_deg, yaw_deg", "all six"},
      {"pose,x_mm,y_mm,z_mm,yaw_deg,fx_N,fy_N,fz_N,ux_mm\na,1,1,1,1,1,1,1,1\n",
       "1: columns missing: roll_deg, pitch_deg;", "all six"},
      {"q1_rad,fx_N,fy_N,fz_N,ux_mm\n1,1,1,1,1\n", "1: column 'pose' is missing", "a label"},
      {"pose,q1_rad,fx_N,ux_mm\na,1,1,1\n", "1: columns missing: fy_N, fz_N;", "all three"},
      {"pose,q1_rad,ux_mm\na,1,1\n", "1: columns missing: fx_N, fy_N, fz_N;", "all three"},
      {"pose,q1_rad,fx_N,fy_N,fz_N\na,1,1,1,1\n", "1: no displacement is measured", "ux_mm, uy_mm"},
  });
}

TEST(Measurements, RefuseCellsWithRemedy) {
  const std::string pose = "0,0,174,0,0,0,", good = "a," + pose + "50,0,0,1,1,1";
  const auto second = [&](const std::string& row, const std::string& more = "") {
    return usual_file(good + (more.empty() ? "" : ",1") + "\n" + row + "\n", more);
  };
  expect_refused({
      {second("a," + pose + "50,0,0,1,x,1"), "3: column 'uy_mm'", "'x' is not a finite number"},
      {second("a," + pose + "50,0,-,1,1,1"), "3: column 'fz_N'", "not a finite number"},
      {second("a," + pose + "50,0,0,1,1e300,1"), "3: column 'uy_mm': 1e300 is out of all proportion", "leave it empty"},
      {second("a," + pose + "1e300,0,0,1,1,1"), "3: column 'fx_N': 1e300 is out of all proportion", "correct"},
      {second("a," + pose + "inf,0,0,1,1,1"), "3: column 'fx_N'", "not a finite number"},
      {second("a," + pose + "50,,0,1,1,1"), "3: column 'fy_N'", "the cell is empty"},
      {second("a,0,,174,0,0,0,50,0,0,1,1,1"), "3: column 'y_mm'", "the cell is empty"},
      {second("b,0,0,174,0,0,zero,50,0,0,1,1,1"), "3: column 'yaw_deg'", "'zero' is not a finite number"},
      {second("b,0,0,174,0,0,0,50,0,0,1,1," + std::string(100000, '1') + "x"), "3: column 'uz_mm'", "…' is not"},
      {second("," + pose + "50,0,0,1,1,1"), "3: column 'pose'", "the label is empty"},
      {second("a,0,0,175,0,0,0,50,0,0,1,1,1"), "3: column 'z_mm': 175 here and 174 in line 2", "another label"},
      {second("a," + pose + "50,0,0,1,1"), "3: 12 cells where the header has 13", "cut short"},
      {second("a," + pose + "50,0,0,1,1,1,"), "3: 14 cells where the header has 13", "separator at the end"},
      {second("a," + pose + "50,0,0,1,5,1,1"), "3: 14 cells", "decimal commas need semicolons"},
      {second("a," + pose + "50,0,0,1,1,1,0", ",sigma_u_mm"), "3: column 'sigma_u_mm': 0 is not positive", "leave"},
      {second("a," + pose + "50,0,0,1,1,1,-2", ",sigma_u_mm"), "3: column 'sigma_u_mm': -2 is not positive", "leave"},
      {second("a," + pose + "50,0,0,1,1,1,0.0", ",sigma_th_rad"), "3: column 'sigma_th_rad': 0.0 is not", "leave"},
      {second("a," + pose + "50,0,0,1,1,1,5e-324", ",sigma_u_mm"), "3: column 'sigma_u_mm'",
       "5e-324 is too small for a standard deviation"},
      {second("a," + pose + "50,0,0,1,1,1,1.0", ",sequence"), "3: column 'sequence': 1.0 stands in line 2 too",
       "order"},
      {usual_file("a," + pose + "50,0,0,1,1,1,9007199254740992\na," + pose + "50,0,0,1,1,1,9007199254740993",
                  ",sequence"),
       "3: column 'sequence': 9007199254740993 and 9007199254740992 in line 2 differ beyond the 16 digits",
       "count from"},
      {second("a," + pose + "50,0,0,1,1,1,", ",sequence"), "3: column 'sequence': the cell is empty",
       "remove the column"},
      {second("a," + pose + "50,0,0,1,1,1,-300", ",temperature_C"), "3: column 'temperature_C'", "absolute zero"},
  });
  EXPECT_EQ(refusal(second("a," + pose + "50,0,0,1,1,1")), "") << "a row may stand twice: a replicate";
}

TEST(Measurements, OneRowIsRead) {
  EXPECT_EQ(parse_measurements(usual_file("a,0,0,174,0,0,0,50,0,0,1,,"), "data.csv").readings.size(), 1u);
}

TEST(Measurements, OrderIsAskedForWhereItIsNeeded) {
  const Measurements m = parse_measurements(usual_file("a,0,0,174,0,0,0,50,0,0,1,,"), "data.csv");
  try {
    in_sequence(m, "friction");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "data.csv:1: column 'sequence' is missing: friction needs the order in which the readings were taken");
  }
}

TEST(Measurements, TimeGrowsWithTheRowsOnly) {
  std::string rows;
  for (int i = 0; i < 100000; ++i) {
    const std::string n = std::to_string(i);
    rows.append(n).append(",0.000000,").append(n).append(",173.898547,0,0,0,-50.0000,0,0,-0.110991,0,0,").append(n) +=
        '\n';
  }
  const std::string text = usual_file(rows, ",sequence");
  const auto start = std::chrono::steady_clock::now();
  const Measurements m = parse_measurements(text, "data.csv");
  EXPECT_EQ(m.poses.size(), 100000u);
  // A quarter of a second, a few without optimisation on a slow machine; anything quadratic would take minutes.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

// What the reader refuses is not written either.
TEST(WrittenMeasurements, NumbersBeyondAllProportionAreRefused) {
  Measurements m;
  Reading r;
  r.displacement[1] = 1e9;
  m.readings = {r};
  m.poses = {{"home", Vector6::Zero(), {}, {0}}};
  const test::Folder folder;
  write_measurements(folder / "data.csv", m);
  m.readings[0].displacement[1] = 1.1e9;
  try {
    write_measurements(folder / "data.csv", m);
    FAIL() << "written";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("1100000000000 in column 'uy_mm' is out of all proportion"), std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace deflect
