// Measurement files as laboratories write them: read, and said how.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/measurements.h"
#include "validation/measurement/column_units.h"

namespace deflect {
namespace {

using namespace measurement;

using test::usual_file;

bool tells(const Measurements& m, const std::string& part) {
  return std::any_of(m.how_read.begin(), m.how_read.end(),
                     [&](const std::string& s) { return s.find(part) != s.npos; });
}

Measurements read(const std::string& text) { return parse_measurements(text, "data.csv"); }

TEST(ColumnUnits, AreConverted) {
  const struct {
    const char *written, *name;
    double one, is;  // so much in the file is so much in the contract's unit
  } cases[] = {
      {"fx_kgf", "fx_N", 1, 9.80665},
      {"FX_KGF", "fx_N", 1, 9.80665},
      {"fy_lbf", "fy_N", 1, 4.4482216152605},
      {"fz_kN", "fz_N", 2, 2000},
      {"fz_mN", "fz_N", 2, 0.002},
      {"mx_Nm", "mx_Nmm", 1, 1000},
      {"mx_kgfm", "mx_Nmm", 1, 9806.65},
      {"ux_in", "ux_mm", 1, 25.4},
      {"ux_um", "ux_mm", 1, 1e-3},
      {"ux_µm", "ux_mm", 1, 1e-3},
      {"ux_\u03BCm", "ux_mm", 1, 1e-3},  // the Greek letter, which looks like the sign
      {"Thx [\u03BCrad]", "thx_rad", 1, 1e-6},
      {"x_m", "x_mm", 1, 1000},
      {"yaw_rad", "yaw_deg", 1, 57.29577951308232},
      {"thx_deg", "thx_rad", 180, 3.141592653589793},
      {"thx_mrad", "thx_rad", 1, 1e-3},
      {"sigma_u_um", "sigma_u_mm", 2, 2e-3},
      {"q3_deg", "q3_rad", 180, 3.141592653589793},
      {"q2_m", "q2_mm", 1, 1000},
      {"temperature_K", "temperature_C", 293.15, 20},
      {"temperature_F", "temperature_C", 68, 20},
      {"Fx [kgf]", "fx_N", 1, 9.80665},
      {"Ux (um)", "ux_mm", 1, 1e-3},
      {"UX_MM", "ux_mm", 1, 1},
      {"MX_NMM", "mx_Nmm", 1, 1},
      {"Pose", "pose", 1, 1},
  };
  for (const auto& c : cases) {
    const auto named = named_column(c.written);
    ASSERT_TRUE(named) << c.written;
    EXPECT_EQ(named->name, c.name) << c.written;
    EXPECT_NEAR(named->factor * (c.one + named->offset), c.is, 1e-12 * std::abs(c.is) + 1e-12) << c.written;
  }
  for (const char* none : {"fx", "fx_furlong", "FX_MN", "q0_rad", "q01_rad", "u_mm", "ux_N", "temp_C", ""})
    EXPECT_FALSE(named_column(none)) << none;
}

TEST(TolerantReader, OtherUnitsAreReadAndSaid) {
  const Measurements m = read(
      "Pose,X_MM,y_mm,z_mm,roll_deg,pitch_deg,yaw_rad,fx_kgf,fy_kgf,fz_kgf,ux_in,uy_um,uz_mm\n"
      "a,0,0,174,0,0,0.5,1,0,0,0.01,5,1e-3\n");
  EXPECT_NEAR(m.readings[0].load(0), 9.80665, 1e-12);
  EXPECT_NEAR(*m.readings[0].displacement[0], 0.254e-3, 1e-15);
  EXPECT_NEAR(*m.readings[0].displacement[1], 5e-6, 1e-18);
  EXPECT_NEAR(m.poses[0].pose_mm_deg(5), 28.64788975654116, 1e-12);
  EXPECT_TRUE(tells(m, "column 'fx_kgf' is read in kgf and becomes fx_N"));
  EXPECT_TRUE(tells(m, "column 'ux_in' is read in in and becomes ux_mm"));
  EXPECT_TRUE(tells(m, "column 'X_MM' is read as x_mm"));
}

TEST(TolerantReader, ARowOfUnitsIsNoReading) {
  const std::string row = "a,0,0,174,0,0,0,50,0,0,1,2,3\n";
  const Measurements plain = read(usual_file(row));
  const Measurements under = read(usual_file(",mm,mm,mm,deg,deg,deg,N,N,N,mm,mm,mm\n" + row));
  EXPECT_EQ(measurements_text(under), measurements_text(plain));
  EXPECT_EQ(under.readings[0].line, 3u);
  EXPECT_TRUE(tells(under, "line 2 holds the units"));
  // Names without units have theirs below.
  const Measurements bare = read(
      "pose,x,y,z,roll,pitch,yaw,fx,fy,fz,ux,uy,uz\n-,[mm],[mm],[m],[°],[°],[°],[N],[N],[kgf],[um],[mm],[mm]\n"
      "a,0,0,0.174,0,0,0,50,0,0,1000,2,3\n");
  EXPECT_EQ(measurements_text(bare), measurements_text(plain));
  // A name and a unit that contradict each other are not guessed at.
  EXPECT_EQ(test::refusal(usual_file(",mm,mm,mm,deg,deg,deg,N,N,N,um,mm,mm\n" + row)),
            "data.csv:2: column 'ux_mm': the unit below is 'um': name and unit must say the same");
  EXPECT_EQ(test::refusal("pose,x,y,z,roll,pitch,yaw,fx,fy,fz,ux,uy,uz\n"
                          "-,mm,mm,mm,deg,deg,deg,N,N,N,mmm,mm,mm\n" +
                          row),
            "data.csv:2: column 'ux': 'mmm' is no unit: write one such as mm, um, N, Nmm, deg or rad, or '-' for none");
}

TEST(TolerantReader, CharactersThatLookLikeOthersAreNamed) {
  EXPECT_EQ(
      test::refusal(usual_file("a,0,0,174,0,0,0,50,0,0,\u22121,2,3\n")),
      "data.csv:2: column 'ux_mm': '\u22121' is not a finite number; write one such as -12.5 or 1.25e-3; it holds "
      "U+2212, a minus sign that is no '-'");
  EXPECT_NE(test::refusal(usual_file("a,0,0,174,0,0,0,50,0,0,1\u00a0,2,3\n")).find("U+00A0, a space that is no ' '"),
            std::string::npos);
}

TEST(TolerantReader, WhatWasNotMeasuredMayBeSaidInWords) {
  const Measurements m = read(usual_file("a,0,0,174,0,0,0,50,0,0,1,NaN,-\na,0,0,174,0,0,0,-50,0,0,#N/A,n/a,2\n"));
  EXPECT_FALSE(m.readings[0].displacement[1] || m.readings[0].displacement[2] || m.readings[1].displacement[0]);
  EXPECT_EQ(m.readings[1].displacement[2], 2e-3);
  EXPECT_TRUE(tells(m, "4 cells such as 'NaN' in line 2 count as not measured"));
}

TEST(TolerantReader, DecimalCommasAreReadAndSaid) {
  const auto with = [](char separator, char decimal) {
    std::string text = usual_file("1:5,0,0,174,0,0,0,50,0,0,1,2,3,4:5\n1:5,0,0,174,0,0,0,0,50,0,1,2:5,3,\n", ",note");
    for (char& c : text) c = c == ',' ? separator : c == ':' ? decimal : c;
    return text;
  };
  const Measurements m = read(with(';', ','));
  EXPECT_EQ(m.readings[1].displacement[1], 2.5e-3);
  EXPECT_EQ(m.how_read, std::vector<std::string>{"numbers with decimal commas are read, as '2,5' in line 3 is 2.5, in "
                                                 "the column uy_mm; semicolons (;) separate columns"});
  EXPECT_TRUE(tells(read(with('\t', ',')), "in the column uy_mm; tabs separate columns"));
  EXPECT_TRUE(read(with(';', '.')).how_read.empty());
}

TEST(TolerantReader, CommentsAndBlankLinesAreSkippedAndSaid) {
  const Measurements m = read("# rig 3\n\n" + usual_file("a,0,0,174,0,0,0,50,0,0,1,2,3\n\n# coffee\n"
                                                         "a,0,0,174,0,0,0,-50,0,0,-1,-2,-3\n"));
  ASSERT_EQ(m.readings.size(), 2u);
  EXPECT_EQ(m.readings[1].line, 7u);
  EXPECT_TRUE(tells(m, "2 lines that begin with '#' are skipped, the first is line 1"));
}

TEST(TolerantReader, PosesOfALabelMayScatterAndTheirMeanIsTaken) {
  const Measurements m = read(usual_file(
      "a,10,0,174,0,0,0,50,0,0,1,2,3\na,10.003,0,174,0,0,0.004,0,50,0,1,2,3\na,10,0,174,0,0,0,0,0,50,1,2,3\n"));
  ASSERT_EQ(m.poses.size(), 1u);
  EXPECT_NEAR(m.poses[0].pose_mm_deg(0), 10.001, 1e-12);
  EXPECT_NEAR(m.poses[0].pose_mm_deg(5), 0.004 / 3, 1e-12);
  EXPECT_TRUE(tells(m, "the poses of 1 label scatter, by 0.003 mm and 0.004 deg from the first at most"));
  EXPECT_NE(test::refusal(usual_file("a,10,0,174,0,0,0,50,0,0,1,2,3\na,10.06,0,174,0,0,0,0,50,0,1,2,3\n"))
                .find("which may scatter by 0.05 mm and 0.05 deg; use another label"),
            std::string::npos);
}

TEST(TolerantReader, AStandardDeviationThatNoInstrumentHasIsAskedAbout) {
  const std::string row = "a,0,0,174,0,0,0,50,0,0,1,2,3,", head = ",sigma_u_mm";
  EXPECT_TRUE(tells(read(usual_file(row + "2e-3\n" + row + "1e-26\n" + row + "1e-12\n", head)),
                    "2 standard deviations such as 1e-26 in line 3, column 'sigma_u_mm', are finer than instruments"));
  EXPECT_TRUE(read(usual_file(row + "1e-9\n", head)).how_read.empty());
}

TEST(TolerantReader, AFileOfTheContractIsReadWithoutAWord) {
  EXPECT_TRUE(read(usual_file("a,0,0,174,0,0,0,50,0,0,1,2,3\n")).how_read.empty());
}

}  // namespace
}  // namespace deflect
