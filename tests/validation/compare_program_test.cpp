// `deflect compare` as a user meets it: sentences, JSON, figures and tables, and what it says of files that it cannot
// use.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/support/csv_columns.h"
#include "tests/support/program.h"

namespace deflect {
namespace {

using nlohmann::json;
using test::columns;
using test::contents;
using test::lines_of;

/// A clamp that tilts, hidden in the 27 readings of the paper.
const std::string& soft_root() {
  static const std::string text = [] {
    const test::Folder folder;
    const std::string file = (folder / "data.csv").string();
    const test::Run run = test::deflect(
        "simulate haptic-6psu-ideal-joints --campaign paper --seed 3 --with "
        "guide_root_compliance,stiffness_Nmm_per_rad=1e6 -o '" +
        file + "'");
    EXPECT_EQ(run.code, 0) << run.out;
    return contents(file);
  }();
  return text;
}

/// The header and the first `rows` rows.
std::string first_rows(const std::string& text, std::size_t rows) {
  std::string out;
  const std::vector<std::string> lines = lines_of(text);
  for (std::size_t i = 0; i <= rows; ++i) out += lines.at(i) + "\n";
  return out;
}

/// Without the last column, which holds σ.
std::string without_sigma(const std::string& text) {
  std::string out;
  for (const std::string& line : lines_of(text)) out += line.substr(0, line.rfind(',')) + "\n";
  return out;
}

std::string with_cell(const std::string& text, std::size_t row, std::size_t column, const std::string& cell) {
  std::string out;
  const std::vector<std::string> lines = lines_of(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::string line = lines[i];
    std::size_t from = 0;
    if (i == row) {
      for (std::size_t k = 0; k < column; ++k) from = line.find(',', from) + 1;
      line.replace(from, std::min(line.find(',', from), line.size()) - from, cell);
    }
    out += line + "\n";
  }
  return out;
}

class CompareProgram : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(soft_root().find(",sigma_u_mm\n") != std::string::npos) << soft_root(); }
  std::string path(const std::string& name) { return "'" + (folder / name).string() + "'"; }
  std::string file(const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
    return path(name);
  }
  test::Run compare(const std::string& text, const std::string& arguments = "") {
    return test::deflect("compare haptic-6psu-ideal-joints " + file("data.csv", text) + " " + arguments);
  }
  json compared(const std::string& text, const std::string& arguments = "") {
    const test::Run run = compare(text, "--json " + path("result.json") + " " + arguments);
    EXPECT_EQ(run.code, 0) << run.out;
    return run.code == 0 ? json::parse(contents(folder / "result.json")) : json();
  }
  void expect_refused(const std::string& text, const std::string& message, const std::string& arguments = "",
                      int code = 2) {
    const test::Run run = compare(text, arguments + " --json " + path("no.json") + " --out " + path("no"));
    EXPECT_EQ(run.code, code) << run.out;
    EXPECT_NE(run.out.find(message), std::string::npos) << run.out;
    EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 1) << run.out;
    EXPECT_FALSE(std::filesystem::exists(folder / "no.json"));
    EXPECT_FALSE(std::filesystem::exists(folder / "no"));
  }

  test::Folder folder;
};

TEST_F(CompareProgram, SaysInSentencesWhereTheModelFails) {
  const test::Run run = compare(soft_root());
  ASSERT_EQ(run.code, 0) << run.out;
  for (const char* says :
       {"haptic-6psu-ideal-joints against ", "data.csv: 27 readings at 9 poses",
        "Something is missing: the model fails", "1. an elastic compliance is missing across the slides",
        "needs pairs of opposite loads", "fx > 0", "pose 8"})
    EXPECT_NE(run.out.find(says), std::string::npos) << says << "\n" << run.out;
  EXPECT_EQ(run.out.find("nan"), std::string::npos) << run.out;
}

TEST_F(CompareProgram, JsonHoldsTheSame) {
  const json j = compared(soft_root());
  for (const char* key :
       {"device", "data", "readings", "poses", "baseline", "noise_floor_mm", "sigma_u_mm", "verdict", "findings",
        "unexplained_chi2_per_dof", "tests", "patterns", "errors", "looks_like", "set_aside_lines"})
    EXPECT_TRUE(j.contains(key)) << key;
  EXPECT_EQ(j["readings"], 27);
  EXPECT_EQ(j["poses"], 9);
  EXPECT_DOUBLE_EQ(j["sigma_u_mm"].get<double>(), 0.002);
  EXPECT_GT(j["baseline"]["rmse_mm"].get<double>(), 0.05);
  EXPECT_GT(j["baseline"]["chi2_per_dof"].get<double>(), 10);
  EXPECT_LT(j["noise_floor_mm"].get<double>(), 0.006);
  ASSERT_FALSE(j["findings"].empty());
  EXPECT_GT(j["findings"][0]["share_of_misfit"].get<double>(), 0.9);
  EXPECT_EQ(j["errors"]["by_pose"].size(), 9u);
}

// Every part of this device yields as 1/E: 1 % of the modulus moves each reading by 1 %, to first order.
TEST_F(CompareProgram, SaysWhichTolerancesMatterMost) {
  const json all = compared(soft_root(), "--out " + path("out"))["tolerances"];
  ASSERT_GT(all.size(), 1u);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end(), [](const json& a, const json& b) {
    return a["rms_mm"].get<double>() > b["rms_mm"].get<double>();
  }));
  double square = 0, count = 0;
  for (const std::string& line : lines_of(columns(contents(folder / "out" / "residuals.csv"), {"predicted"})))
    if (line != "predicted") square += std::stod(line) * std::stod(line), ++count;
  const auto modulus = std::find_if(all.begin(), all.end(), [](const json& t) { return t["name"] == "modulus"; });
  ASSERT_NE(modulus, all.end());
  EXPECT_NEAR((*modulus)["rms_mm"].get<double>(), 0.01 * std::sqrt(square / count), 3e-4 * std::sqrt(square / count));
}

/// The names of all figures that were drawn.
std::set<std::string> figures_in(const std::filesystem::path& out) {
  std::set<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(out))
    if (file.path().extension() == ".svg") names.insert(file.path().stem().string());
  return names;
}

TEST_F(CompareProgram, FiguresAndTablesAreWhole) {
  const test::Run run = compare(soft_root(), "--out " + path("out"));
  ASSERT_EQ(run.code, 0) << run.out;
  const std::set<std::string> figures = figures_in(folder / "out");
  for (const char* name : {"residuals", "residual-map", "groups", "secant", "elongation", "loops"})
    EXPECT_TRUE(figures.contains(name)) << name;
  for (const std::string& name : figures) {
    const std::string svg = contents(folder / "out" / (name + ".svg")),
                      pdf = contents(folder / "out" / (name + ".pdf")),
                      png = contents(folder / "out" / (name + ".png"));
    EXPECT_TRUE(svg.starts_with("<?xml")) << name;
    EXPECT_NE(svg.find("</svg>"), std::string::npos) << name;
    EXPECT_TRUE(pdf.starts_with("%PDF")) << name;
    EXPECT_NE(pdf.rfind("%%EOF"), std::string::npos) << name;
    EXPECT_TRUE(png.starts_with("\x89PNG\r\n\x1a\n")) << name;
    EXPECT_NE(png.rfind("IEND"), std::string::npos) << name;
  }
  EXPECT_EQ(lines_of(contents(folder / "out" / "residuals.csv")).size(), 1u + 81);
  EXPECT_TRUE(contents(folder / "out" / "errors.csv").starts_with("group,readings,rmse_um,"));
  EXPECT_TRUE(contents(folder / "out" / "tests.csv").starts_with("kind,name,numbers,size_um,p_value\n"));
}

TEST_F(CompareProgram, WhatIsNotMeasuredOrLoadedIsNotDrawn) {
  const std::vector<std::string> pose = {"pose",      "x_mm",    "y_mm", "z_mm", "roll_deg",
                                         "pitch_deg", "yaw_deg", "fx_N", "fy_N", "fz_N"};
  ASSERT_EQ(
      test::deflect("simulate haptic-6psu-ideal-joints --campaign paper --noise-rotation 1e-5 -o " + path("all.csv"))
          .code,
      0);
  const auto drawn = [&](std::vector<std::string> names) {
    names.insert(names.begin(), pose.begin(), pose.end());
    const test::Run run = compare(columns(contents(folder / "all.csv"), names), "--out " + path(names.at(10)));
    EXPECT_EQ(run.code, 0) << run.out;
  };
  drawn({"ux_mm", "sigma_u_mm"});
  EXPECT_NE(contents(folder / "ux_mm" / "residuals.svg").find("Δx"), std::string::npos);
  EXPECT_EQ(contents(folder / "ux_mm" / "residuals.svg").find("Δy"), std::string::npos);
}

TEST_F(CompareProgram, RotationsAloneAreNotCalledMicrometres) {
  ASSERT_EQ(test::deflect("simulate haptic-6psu-ideal-joints --campaign paper --noise-rotation 1e-5 --with "
                          "guide_root_compliance,stiffness_Nmm_per_rad=1e6 -o " +
                          path("all.csv"))
                .code,
            0);
  const std::string text =
      columns(contents(folder / "all.csv"), {"pose", "x_mm", "y_mm", "z_mm", "roll_deg", "pitch_deg", "yaw_deg", "fx_N",
                                             "fy_N", "fz_N", "thx_rad", "thy_rad", "sigma_th_rad"});
  const test::Run run = compare(text, "--out " + path("out") + " --json " + path("r.json"));
  ASSERT_EQ(run.code, 0) << run.out;
  EXPECT_NE(run.out.find("µrad rms"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("measured − predicted, µrad"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("µm rms"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("predicted, µm"), std::string::npos) << run.out;
  EXPECT_TRUE(contents(folder / "out" / "errors.csv").starts_with("group,readings,rmse_urad,"));
  EXPECT_TRUE(contents(folder / "out" / "tests.csv").starts_with("kind,name,numbers,size_urad,"));
  for (const char* name : {"residuals", "residual-map", "groups", "elongation"}) {
    const std::string svg = contents(folder / "out" / (std::string(name) + ".svg"));
    EXPECT_NE(svg.find("µrad"), std::string::npos) << name;
    if (name != std::string("elongation")) {
      EXPECT_EQ(svg.substr(svg.find("</desc>")).find("µm"), std::string::npos) << name;
    }
    EXPECT_NE(contents(folder / "out" / (std::string(name) + ".txt")).find("otations"), std::string::npos) << name;
  }
  const json j = json::parse(contents(folder / "r.json"));
  EXPECT_EQ(j["unit"], "mrad");
  EXPECT_GT(j["noise_floor_mm"].get<double>(), 0.009) << "noise of rotations counts where they are all there is";
  EXPECT_GT(j["baseline"]["held_out_rmse_mm"].get<double>(), 0);
}

TEST_F(CompareProgram, RotationsBesideTranslationsDoNotEnterMillimetres) {
  ASSERT_EQ(
      test::deflect("simulate haptic-6psu-ideal-joints --campaign paper --noise-rotation 1e-3 -o " + path("all.csv"))
          .code,
      0);
  const json j = compared(contents(folder / "all.csv"));
  EXPECT_NEAR(j["sigma_u_mm"].get<double>(), 0.002, 1e-9);
  for (const json& pattern : j["patterns"])
    if (pattern["pattern"] == "load gain") {
      EXPECT_LT(pattern["size_mm"].get<double>(), 0.02);
    }
}

TEST_F(CompareProgram, ResidualMapIsSigned) {
  const test::Run run = compare(soft_root(), "--out " + path("out"));
  ASSERT_EQ(run.code, 0) << run.out;
  const std::string svg = contents(folder / "out" / "residual-map.svg"),
                    caption = contents(folder / "out" / "residual-map.txt");
  for (const char* text : {"Δx in the sense of fx", "Δy, mean", "µm", "−"})
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  for (const char* text : {"one scale of ±", "base axes", "27 readings at 9 poses", "fx 0 … 50",
                           "Standard deviation of "
                           "a reading 2 µm",
                           "deflect 0."})
    EXPECT_NE(caption.find(text), std::string::npos) << text << "\n" << caption;
}

TEST_F(CompareProgram, FiguresFitTheColumnThatIsAskedFor) {
  const test::Run run = compare(soft_root(),
                                "--figure-width '88 mm' --figure-font 'DejaVu Serif' --figure-font-size 7 "
                                "--out " +
                                    path("out"));
  ASSERT_EQ(run.code, 0) << run.out;
  for (const std::string& name : figures_in(folder / "out")) {
    const std::string svg = contents(folder / "out" / (name + ".svg"));
    EXPECT_NE(svg.find("width=\"88mm\""), std::string::npos) << name;
    EXPECT_NE(svg.find("font-size=\"7.00\""), std::string::npos) << name;
    EXPECT_EQ(svg.find("DejaVu Sans"), std::string::npos) << name;
  }
  expect_refused(soft_root(), "--figure-width: '88'", "--figure-width 88");
  expect_refused(soft_root(), "figures: 30 mm are too narrow for text of 8 pt", "--figure-width '30 mm'");
  expect_refused(soft_root(), "'No Such Family' is not installed", "--figure-font 'No Such Family'");
  const test::Run without = compare(soft_root(), "--figure-width '88 mm'");
  EXPECT_EQ(without.code, 2);
  EXPECT_NE(without.out.find("belong to --out"), std::string::npos) << without.out;
}

TEST_F(CompareProgram, ThreadsDoNotChangeADigit) {
  const json one = compared(soft_root(), "--threads 1");
  const std::string text = contents(folder / "result.json");
  compared(soft_root(), "--threads 3");
  EXPECT_EQ(contents(folder / "result.json"), text);
  EXPECT_FALSE(one.empty());
}

TEST_F(CompareProgram, AFileIsTheSameHoweverItWasSaved) {
  const std::string plain = soft_root();
  std::string crlf, semicolons;
  for (const char c : plain) {
    crlf += c == '\n' ? "\r\n" : std::string(1, c);
    semicolons += c == ',' ? ';' : c == '.' ? ',' : c;
  }
  const auto result_of = [&](const std::string& text) {
    json result = compared(text);
    result.erase("provenance");                                                       // the hash of the file
    EXPECT_EQ(result.at("notes").size(), text.find("0,002") != text.npos ? 1u : 0u);  // that there are decimal commas
    result.erase("notes");
    return result;
  };
  const json result = result_of(plain);
  for (const std::string& text : {crlf, semicolons, "\xEF\xBB\xBF" + plain, "\xEF\xBB\xBF" + semicolons})
    EXPECT_EQ(result_of(text), result) << text.substr(0, 200);
}

TEST_F(CompareProgram, ANumberThatIsNoneWasNotMeasuredAndIsSaid) {
  const test::Run run = compare(with_cell(soft_root(), 2, 11, "nan"));
  EXPECT_EQ(run.code, 0) << run.out;
  EXPECT_NE(run.out.find("1 cell such as 'nan' in line 3 count as not measured"), std::string::npos) << run.out;
}

TEST_F(CompareProgram, RefusesBadFilesWithLineAndColumn) {
  expect_refused(with_cell(soft_root(), 4, 8, "fifty"), "data.csv:5: column 'fx_N': 'fifty' is not a finite number");
  expect_refused(with_cell(soft_root(), 2, 14, "0"), "data.csv:3: column 'sigma_u_mm'");
  expect_refused(with_cell(soft_root(), 2, 8, "nan"), "data.csv:3: column 'fx_N'");
  expect_refused(with_cell(soft_root(), 0, 11, "ux"), "data.csv:1: unknown column 'ux'");
  expect_refused(with_cell(soft_root(), 2, 4, "900"), "data.csv:3: ", "", 2);
  expect_refused("", "data.csv:1: ");
  expect_refused(first_rows(soft_root(), 0), "no row below");
  expect_refused(first_rows(soft_root(), 1), "one reading says nothing of a model: two or more are wanted");
  const test::Run none = test::deflect("compare haptic-6psu-ideal-joints " + path("none.csv"));
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.out.find("none.csv: cannot be read"), std::string::npos) << none.out;
  const test::Run device = test::deflect("compare haptic-6ps " + file("data.csv", soft_root()));
  EXPECT_EQ(device.code, 2);
  EXPECT_NE(device.out.find("did you mean 'haptic-6psu'?"), std::string::npos) << device.out;
}

TEST_F(CompareProgram, APoseOutOfReachIsNamedByLine) {
  std::string far = soft_root();
  for (std::size_t row = 1; row <= 3; ++row) far = with_cell(far, row, 4, "900");
  expect_refused(far, "data.csv:2: ", "", 3);
}

TEST_F(CompareProgram, WithoutSigmaTheScatterIsReadOffOrAskedFor) {
  const std::string bare = without_sigma(soft_root());
  const json own = compared(bare);
  EXPECT_EQ(own["sigma_from_residuals"], true);
  EXPECT_GT(own["sigma_u_mm"].get<double>(), 0);
  const test::Run run = compare(bare);
  EXPECT_NE(run.out.find("from the residuals: neither σ nor replicates in the file"), std::string::npos) << run.out;
  const json given = compared(bare, "--sigma 0.002");
  EXPECT_EQ(given["sigma_from_residuals"], false);
  EXPECT_DOUBLE_EQ(given["sigma_u_mm"].get<double>(), 0.002);
  for (const std::size_t rows : {2u, 3u, 6u})
    expect_refused(first_rows(bare, rows), "too few to read the scatter off what no pattern explains");
  expect_refused(first_rows(bare, 3), "give --sigma");
}

TEST_F(CompareProgram, AFewReadingsAreCompared) {
  for (const std::size_t rows : {2u, 3u, 5u}) {
    const json j = compared(first_rows(soft_root(), rows), rows == 2 ? "--out " + path("few") : "");
    EXPECT_EQ(j["readings"], rows);
    EXPECT_GE(j["unexplained_chi2_per_dof"].get<double>(), 0);
    if (j["poses"] == 1) {
      EXPECT_EQ(j["baseline"]["held_out_rmse_mm"], j["baseline"]["rmse_mm"]) << "nothing is learnt elsewhere";
    }
  }
}

TEST_F(CompareProgram, RefusesOptionsThatCannotBe) {
  expect_refused(soft_root(), "a standard deviation above zero, in mm", "--sigma 0");
  expect_refused(soft_root(), "a standard deviation above zero, in mm", "--sigma=-1");
  expect_refused(soft_root(), "--sigma 'nan'", "--sigma nan");
  expect_refused(soft_root(), "--sigma 'inf'", "--sigma inf");
  expect_refused(soft_root(), "--sigma 1e-27: is too small for a standard deviation", "--sigma 1e-27");
  expect_refused(soft_root(), "a standard deviation above zero, in rad", "--sigma-rotation 0");
  expect_refused(soft_root(), "--threads -1: give a whole number", "--threads=-1");
}

TEST_F(CompareProgram, FilesThatCannotBeWrittenAreSaid) {
  const std::string data = file("data.csv", soft_root());
  for (const std::string& arguments : {"--json " + path("data.csv/r.json"), "--out " + path("data.csv/out")}) {
    const test::Run run = test::deflect("compare haptic-6psu-ideal-joints " + data + " " + arguments);
    EXPECT_EQ(run.code, 2) << run.out;
    EXPECT_NE(run.out.find("cannot be written (" + (folder / "data.csv").string() + " is no"), run.out.npos) << run.out;
    EXPECT_EQ(run.out.find("readings at"), std::string::npos) << run.out;  // before the work
  }
  EXPECT_EQ(contents(folder / "data.csv"), soft_root());
}

// Twenty poses: the report has the ten worst, the files have all.
TEST_F(CompareProgram, OfManyPosesTheReportHasTheWorst) {
  std::string plan = "pose,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg,fx_N,fy_N,fz_N\n";
  for (int p = 0; p < 20; ++p)
    for (const char* load : {"50,0,0", "0,50,0"})
      plan += "p" + std::to_string(p) + "," + std::to_string(p - 10) + ",0,173.9,0,0,0," + load + "\n";
  ASSERT_EQ(test::deflect("simulate haptic-6psu-ideal-joints --campaign " + file("plan.csv", plan) + " -o " +
                          path("twenty.csv"))
                .code,
            0);
  const test::Run run =
      compare(contents(folder / "twenty.csv"), "--json " + path("result.json") + " --out " + path("out"));
  ASSERT_EQ(run.code, 0) << run.out;
  const json j = json::parse(contents(folder / "result.json"));
  ASSERT_EQ(j["errors"]["by_pose"].size(), 20u);
  std::vector<std::pair<double, std::string>> poses;
  for (const json& e : j["errors"]["by_pose"]) poses.emplace_back(-e["rmse_mm"].get<double>(), e["group"]);
  std::sort(poses.begin(), poses.end());
  std::size_t from = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::size_t at = run.out.find("\n  " + poses[i].second + " ");
    EXPECT_EQ(at != run.out.npos, i < 10) << poses[i].second << "\n" << run.out;
    if (i >= 10) continue;
    EXPECT_GT(at, from) << "the worst first";
    from = at;
  }
  EXPECT_NE(run.out.find("these poses are the worst; 10 more are in the files of --json and --out"), std::string::npos)
      << run.out;
  EXPECT_NE(contents(folder / "out" / "errors.csv").find("\"" + poses.back().second + "\""), std::string::npos);
}

}  // namespace
}  // namespace deflect
