#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "msa/base/error.h"
#include "tests/support/theories.h"
#include "validation/measurement/csv.h"
#include "validation/report/solve_results.h"
#include "validation/report/text.h"
#include "validation/report/validation_results.h"

namespace deflect {
namespace {

using namespace measurement;
using namespace report;
using namespace studies;
using namespace theories;

const double nan_value = std::numeric_limits<double>::quiet_NaN();

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

Vector6 vector(double seed) {
  Vector6 v;
  for (int i = 0; i < 6; ++i) v[i] = std::sin(seed + i) / 3;  // no short decimal form
  return v;
}

Validation validation(bool as_printed) {
  Validation v;
  v.device = "haptic-6psu";
  v.theories = all_theories();
  v.max_relative_difference = 1.25e-9 / 3;
  v.rms_relative_difference = 4.5e-10 / 3;
  if (as_printed) v.as_printed = {Erratum::passive_joints, Erratum::tcp_transfer};
  for (int p = 0; p < 9; ++p)
    for (int axis = 0; axis < 3; ++axis) {
      ValidationRow row;
      row.point = {std::to_string(p), vector(100 + p)};
      row.axis = axis;
      row.load_N = 50;
      row.displacements.assign(2, vector(3 * p + axis));
      test::msa(row)[axis] = 0.1 * (p + 1) + 0.01 * axis;
      test::analytic(row) = test::msa(row) * (1 + 1e-9);
      row.relative_difference = 1e-9;
      if (as_printed) row.as_printed = test::analytic(row) / 2;
      v.rows.push_back(row);
    }
  return v;
}

Vector6 vector(const nlohmann::json& list) {
  EXPECT_EQ(list.size(), 6u);
  Vector6 v;
  for (int i = 0; i < 6; ++i) v[i] = list.at(static_cast<std::size_t>(i)).get<double>();
  return v;
}

TEST(ValidationJson, ReadsBackToTheLastBit) {
  for (const bool as_printed : {false, true}) {
    const Validation v = validation(as_printed);
    const auto json = nlohmann::json::parse(validation_json(v));
    EXPECT_EQ(json.at("device"), "haptic-6psu");
    EXPECT_EQ(json.at("max_relative_difference").get<double>(), v.max_relative_difference);
    EXPECT_EQ(json.at("rms_relative_difference").get<double>(), v.rms_relative_difference);
    ASSERT_EQ(json.at("points").size(), 27u);
    for (std::size_t i = 0; i < 27; ++i) {
      const auto& entry = json["points"][i];
      const ValidationRow& row = v.rows[i];
      EXPECT_TRUE(entry.at("point").is_number_integer());
      EXPECT_EQ(entry["point"].get<int>(), static_cast<int>(i / 3));
      EXPECT_EQ(entry.at("load_axis"), std::string(1, "xyz"[i % 3]));
      EXPECT_EQ(entry.at("load_N").get<double>(), 50);
      EXPECT_EQ(vector(entry.at("pose")), row.point.pose_mm_deg);
      EXPECT_EQ(vector(entry.at("analytic")), test::analytic(row));
      EXPECT_EQ(vector(entry.at("msa")), test::msa(row));
      EXPECT_EQ(entry.contains("as_printed"), as_printed);
      if (as_printed) {
        EXPECT_EQ(vector(entry["as_printed"]), *row.as_printed);
      }
    }
  }
}

TEST(ValidationJson, PointIsAnIntegerOnlyWhereTheLabelIsOne) {
  Validation v = validation(false);
  v.rows.resize(6);
  const char* labels[] = {"12", "-3", "P7", "007", "1.0", "µ \"quoted\""};
  for (std::size_t i = 0; i < 6; ++i) v.rows[i].point.label = labels[i];
  const auto points = nlohmann::json::parse(validation_json(v)).at("points");
  EXPECT_EQ(points[0]["point"], 12);
  EXPECT_EQ(points[1]["point"], -3);
  for (std::size_t i = 2; i < 6; ++i) EXPECT_EQ(points[i]["point"], labels[i]);
}

TEST(ValidationResults, NumbersThatAreNoneAreNeverWritten) {
  for (const double bad : {nan_value, std::numeric_limits<double>::infinity()}) {
    Validation v = validation(true);
    (*v.rows[4].as_printed)[5] = bad;
    EXPECT_THROW(validation_json(v), NumericalError);
    EXPECT_THROW(validation_csv(v), NumericalError);
    try {
      validation_json(v);
    } catch (const NumericalError& error) {
      EXPECT_TRUE(has(error.what(), "point 1, load along y, as_printed[5]")) << error.what();
    }
  }
  Validation v = validation(false);
  v.rms_relative_difference = nan_value;
  EXPECT_THROW(validation_json(v), NumericalError);
}

TEST(ValidationCsv, ReadsBackToTheLastBit) {
  for (const bool as_printed : {false, true}) {
    Validation v = validation(as_printed);
    v.rows[3].point.label = v.rows[4].point.label = v.rows[5].point.label = "left, \"upper\"";
    if (as_printed) v.rows[7].as_printed.reset();
    const CsvTable table = parse_csv(validation_csv(v), "out.csv");
    ASSERT_EQ(table.rows(), 27u);
    EXPECT_EQ(table.header().size(), as_printed ? 28u : 22u);
    EXPECT_EQ(table.text(3, *table.column("point")), "left, \"upper\"");
    for (std::size_t r = 0; r < 27; ++r) {
      const ValidationRow& row = v.rows[r];
      EXPECT_EQ(table.text(r, *table.column("load_axis")), std::string(1, "xyz"[r % 3]));
      EXPECT_EQ(table.number(r, *table.column("load_N")), 50);
      EXPECT_EQ(table.number(r, *table.column("x_mm")), row.point.pose_mm_deg[0]);
      EXPECT_EQ(table.number(r, *table.column("yaw_deg")), row.point.pose_mm_deg[5]);
      EXPECT_EQ(table.number(r, *table.column("analytic_ux_mm")), test::analytic(row)[0]);
      EXPECT_EQ(table.number(r, *table.column("analytic_thz_rad")), test::analytic(row)[5]);
      EXPECT_EQ(table.number(r, *table.column("msa_uy_mm")), test::msa(row)[1]);
      EXPECT_EQ(table.number(r, *table.column("relative_difference")), row.relative_difference);
      if (row.as_printed) {
        EXPECT_EQ(table.number(r, *table.column("as_printed_thx_rad")), (*row.as_printed)[3]);
      }
    }
    if (as_printed) {
      EXPECT_EQ(table.text(7, *table.column("as_printed_ux_mm")), "");
    }
  }
}

TEST(ValidationTable, OneLinePerPointWithBothTheories) {
  Validation v = validation(false);
  v.rows[4].relative_difference = 2e-6;
  const std::string table = validation_table(v);
  EXPECT_TRUE(has(table, "haptic-6psu")) << table;
  EXPECT_TRUE(has(table, "50 N"));
  EXPECT_TRUE(has(table, "\n0        0.100000    0.110000    0.120000  0.100000  0.110000  0.120000     1.0e-09\n"))
      << table;
  EXPECT_TRUE(has(table, "\n1        0.200000    0.210000    0.220000  0.200000  0.210000  0.220000     2.0e-06\n"))
      << table;
  EXPECT_TRUE(has(table, "largest 4.2e-10, rms 1.5e-10, 27 cases")) << table;
}

TEST(ValidationTable, AsPrintedShowsTheRatio) {
  Validation v = validation(true);
  const std::string table = validation_table(v);
  EXPECT_TRUE(has(table, "errata passive-joints, tcp-transfer")) << table;
  EXPECT_TRUE(has(table, "\n8         z    0.460000   0.920000  0.920000              2.000     1.0e-09\n")) << table;
  (*v.rows[0].as_printed)[0] = 0;
  v.rows[1].as_printed.reset();
  EXPECT_TRUE(has(validation_table(v), "–"));
}

TEST(ValidationTable, MissingLoadsAndNaNShow) {
  Validation v = validation(false);
  v.rows.erase(v.rows.begin() + 1);
  v.rows[0].relative_difference = nan_value;
  const std::string table = validation_table(v);
  EXPECT_TRUE(has(table, "\n0        0.100000           –    0.120000  0.100000         –  0.120000         nan\n"))
      << table;
  EXPECT_THROW(validation_table(Validation{}), std::invalid_argument);
}

SolveResult solution() {
  SolveResult r;
  r.pose_mm_deg << 0, 12.5, 173.898547, 0, 0, 30;
  r.load_N_Nmm << 50, 0, -12.5, 0, 100, 0;
  Matrix6 K = Matrix6::Identity() * 600;
  K(0, 4) = K(4, 0) = 1.0 / 3;
  K(2, 3) = 1e-14;
  r.theories = all_theories();
  r.solutions = {{vector(1) * (1 + 1e-9), K}, {vector(1), K}};
  test::analytic(r).stiffness_mm(1, 5) += 6e-4;
  r.relative_difference = 1e-9;
  r.passive_joints_free = false;
  r.shares = {{"link", 0.0712}, {"guideway", 0.9288}};
  return r;
}

TEST(SolveJson, ReadsBackToTheLastBit) {
  const SolveResult r = solution();
  const auto json = nlohmann::json::parse(solve_json(r));
  EXPECT_EQ(vector(json.at("pose")), r.pose_mm_deg);
  EXPECT_EQ(vector(json.at("load")), r.load_N_Nmm);
  for (const auto& [name, theory] : {std::pair{"analytic", &test::analytic(r)}, std::pair{"msa", &test::msa(r)}}) {
    EXPECT_EQ(vector(json.at(name).at("displacement")), theory->displacement_mm_rad);
    ASSERT_EQ(json[name].at("stiffness").size(), 6u);
    for (int i = 0; i < 6; ++i)
      EXPECT_EQ(vector(json[name]["stiffness"][static_cast<std::size_t>(i)]), theory->stiffness_mm.row(i).transpose());
  }
  EXPECT_EQ(json.at("relative_difference").get<double>(), 1e-9);
  EXPECT_EQ(json.at("checks"),
            nlohmann::json({{"symmetric", true}, {"positive", true}, {"passive_joints_free", false}}));
  EXPECT_EQ(json.at("shares"),
            nlohmann::json::parse(R"([{"part": "link", "share": 0.0712}, {"part": "guideway", "share": 0.9288}])"));
  EXPECT_EQ(json.at("joints"), nlohmann::json::array());
  EXPECT_EQ(json.at("redundant_constraints"), 0);
  EXPECT_EQ(json.at("kind"), "solve");
  EXPECT_EQ(json.at("theories").size(), 2u);
  EXPECT_EQ(json.at("reference"), "msa");
  EXPECT_EQ(json.size(), 12u);
}

TEST(SolveJson, HoldsJointsOverConstraintAndTheForcesOfAssembly) {
  SolveResult r = solution();
  r.joints = {{"leg 1 slide", 80.5, false}, {"spindle", 0.25, true}};
  r.redundant_constraints = 3;
  r.assembly = Assembly{{Vector6::Constant(1), Vector6::Constant(2)}, {{"leg 1", Vector6::Constant(3)}}};
  const auto json = nlohmann::json::parse(solve_json(r));
  EXPECT_EQ(json.at("joints"), nlohmann::json::parse(R"([{"name": "leg 1 slide", "value_mm": 80.5},
                                                         {"name": "spindle", "value_rad": 0.25}])"));
  EXPECT_EQ(json.at("redundant_constraints"), 3);
  EXPECT_EQ(vector(json.at("assembly").at("analytic_offset")), Vector6::Constant(1));
  EXPECT_EQ(vector(json.at("assembly").at("msa_offset")), Vector6::Constant(2));
  EXPECT_EQ(vector(json.at("assembly").at("leg_wrenches_N_Nmm").at("leg 1")), Vector6::Constant(3));
  const std::string text = solve_report(r);
  for (const char* words : {"leg 1 slide 80.5 mm", "spindle 0.25 rad", "3 more constraints", "on leg 1 at T"})
    EXPECT_NE(text.find(words), std::string::npos) << words;
}

TEST(SolveJson, NumbersThatAreNoneAreNeverWritten) {
  SolveResult r = solution();
  test::msa(r).stiffness_mm(2, 3) = nan_value;
  try {
    solve_json(r);
    ADD_FAILURE();
  } catch (const NumericalError& error) {
    EXPECT_TRUE(has(error.what(), "msa.stiffness[2][3]")) << error.what();
  }
  r = solution();
  r.shares[1].second = nan_value;
  EXPECT_THROW(solve_json(r), NumericalError);
}

TEST(SolveReport, ForAPerson) {
  const std::string report = solve_report(solution());
  EXPECT_TRUE(has(report, "pose   x 0, y 12.5, z 173.898547 mm; roll 0, pitch 0, yaw 30 deg\n")) << report;
  EXPECT_TRUE(has(report, "load   fx 50, fy 0, fz -12.5 N; mx 0, my 100, mz 0 Nmm\n")) << report;
  EXPECT_TRUE(has(report, "  ux              0.280490      0.280490   mm\n")) << report;
  EXPECT_TRUE(has(report, "  thz         -0.093138499  -0.093138499  rad\n")) << report;
  EXPECT_TRUE(has(report, "0.333333")) << report;
  EXPECT_FALSE(has(report, "1e-14")) << report;
  EXPECT_TRUE(has(report, "differs by at most 1.0e-06 of √(K_ii K_jj), at fy thz")) << report;
  EXPECT_LT(report.find("guideway"), report.find("link")) << "largest share first";
  EXPECT_TRUE(has(report, "92.88 %")) << report;
  EXPECT_TRUE(has(report, "stiffness positive   yes")) << report;
  EXPECT_TRUE(has(report, "passive joints free   NO")) << report;
}

TEST(Text, AQuotedCellDoublesItsQuotes) {
  EXPECT_EQ(csv_cell("left, 2"), "\"left, 2\"");
  EXPECT_EQ(csv_cell("a \"b\""), "\"a \"\"b\"\"\"");
}

TEST(Text, ColumnsLinesAndClipsCountLetters) {
  EXPECT_EQ(aligned({{"µm", "1"}, {"a", "10"}, {"b"}}), "µm   1\na   10\nb\n");
  EXPECT_EQ(wrap("one two three", 7), (std::vector<std::string>{"one two", "three"}));
  EXPECT_EQ(wrap("longword a", 3), (std::vector<std::string>{"longword", "a"}));
  EXPECT_EQ(clip("µµµµ", 4), "µµµµ");
  EXPECT_EQ(clip("µµµµµ", 4), "µµµ…");
}

}  // namespace
}  // namespace deflect
