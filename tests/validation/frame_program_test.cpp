// `deflect frame` as a user meets it.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>

#include "tests/support/program.h"
#include "validation/measurement/csv.h"

namespace deflect {
namespace {

using namespace measurement;

using nlohmann::json;
using test::contents;
using test::deflect;
using test::Folder;

const std::string file = R"(name: bracket
materials:
  steel: {E: 200 GPa, nu: 0.3, density: 7850 kg/m^3}
sections:
  rod: {shape: round, diameter: 10 mm}
nodes:
  foot: [0 mm, 0 mm, 0 mm]
  top: [0 mm, 0 mm, 200 mm]
  tip: [300 mm, 0 mm, 200 mm]
members:
  post: {from: foot, to: top, section: rod, material: steel}
  arm: {from: top, to: tip, section: rod, material: steel}
supports:
  foot: clamped
springs:
  stay: {node: tip, ux: 20 N/mm}
constraints:
  upright: {terms: [{node: top, freedom: ry}]}
loads:
  own weight: {gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]}
  force: {nodes: {tip: {fz: -50 N}}}
)";

std::string written(const Folder& folder, const std::string& text) {
  const std::string path = (folder / "frame.yaml").string();
  std::ofstream(path) << text;
  return "'" + path + "'";
}

TEST(FrameProgram, SaysWhatSolvedTheEquations) {
  const Folder folder;
  const std::string frame = written(folder, file), to = " --json '" + (folder / "r.json").string() + "'";
  const auto direct = deflect("frame " + frame + to);
  ASSERT_EQ(direct.code, 0) << direct.out;
  EXPECT_NE(direct.out.find("solver: direct (18 freedoms, fewer than 20000)\n"), std::string::npos) << direct.out;
  json solver = json::parse(contents(folder / "r.json"))["solver"];
  EXPECT_EQ(solver["name"], "direct");
  EXPECT_EQ(solver["why"], "18 freedoms, fewer than 20000");
  EXPECT_FALSE(solver.contains("error_bound"));

  const auto iterative = deflect("frame " + frame + to + " --solver iterative");
  ASSERT_EQ(iterative.code, 0) << iterative.out;
  EXPECT_NE(iterative.out.find("solver: iterative (as asked for), "), std::string::npos) << iterative.out;
  solver = json::parse(contents(folder / "r.json"))["solver"];
  EXPECT_EQ(solver["name"], "iterative");
  EXPECT_EQ(solver["freedoms"], 11);
  EXPECT_GT(solver["iterations"], 0);
  EXPECT_LE(solver["error_bound"], 1e-8);

  const auto wrong = deflect("frame " + frame + " --solver fast");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.out.find("--solver: 'fast' is none of auto, direct, iterative"), std::string::npos) << wrong.out;
}

TEST(FrameProgram, WritesJsonTablesAndDeflectedShapes) {
  const Folder folder;
  const auto run = deflect("frame " + written(folder, file) + " --json '" + (folder / "r.json").string() + "' --out '" +
                           (folder / "out").string() + "'");
  ASSERT_EQ(run.code, 0) << run.out;
  for (const char* phrase : {"bracket: 3 nodes, 2 members, 2 load cases", "load case 'own weight'", "reactions",
                             "strain energy", "reciprocity"})
    EXPECT_NE(run.out.find(phrase), std::string::npos) << phrase << "\n" << run.out;

  const json r = json::parse(contents(folder / "r.json"));
  EXPECT_EQ(r["frame"], "bracket");
  ASSERT_EQ(r["cases"].size(), 2u);
  const json& c = r["cases"]["force"];
  ASSERT_EQ(c["displacements"].size(), 3u);
  EXPECT_EQ(c["displacements"][2]["node"], "tip");
  const double I = M_PI * 1e4 / 64, bent = -50 * std::pow(300, 3) / (3 * 200e3 * I), A = M_PI * 25;
  EXPECT_NEAR(c["displacements"][2]["uz_mm"].get<double>(), bent - 50 * 200 / (200e3 * A), 1e-9);
  EXPECT_NEAR(c["reactions"][0]["fz_N"].get<double>(), 50, 1e-9);
  EXPECT_NEAR(c["constraints"][0]["moment_Nmm"].get<double>(), -15000, 1e-6);
  EXPECT_EQ(c["springs"][0].size(), 2u);  // name and the one stiffness it has
  EXPECT_EQ(c["members"][1]["member"], "arm");
  EXPECT_NEAR(c["members"][1]["start"]["Mz_Nmm"].get<double>(), -15000, 1e-6);
  EXPECT_EQ(c["shares"][0]["part"], "rod");
  for (const char* check : {"residual", "equilibrium", "energy"}) EXPECT_LT(c["checks"][check].get<double>(), 1e-9);
  EXPECT_LT(r["reciprocity"].get<double>(), 1e-12);

  const CsvTable u = read_csv((folder / "out" / "displacements.csv").string());
  ASSERT_EQ(u.rows(), 6u);
  EXPECT_EQ(u.text(5, 0), "force");
  EXPECT_EQ(u.text(5, 1), "tip");
  EXPECT_EQ(u.number(5, *u.column("uz_mm")), c["displacements"][2]["uz_mm"].get<double>());
  const CsvTable reactions = read_csv((folder / "out" / "reactions.csv").string());
  ASSERT_EQ(reactions.rows(), 4u);
  EXPECT_EQ(reactions.text(3, 1), "spring");
  EXPECT_EQ(reactions.text(3, *reactions.column("fy_N")), "");
  const CsvTable members = read_csv((folder / "out" / "members.csv").string());
  EXPECT_EQ(members.number(3, *members.column("Mz_start_Nmm")), c["members"][1]["start"]["Mz_Nmm"].get<double>());
  const CsvTable shares = read_csv((folder / "out" / "shares.csv").string());
  EXPECT_NEAR(shares.number(2, *shares.column("share")) + shares.number(3, *shares.column("share")), 1, 1e-12);
  for (const char* name : {"own weight.vtu", "own weight.msh", "force.vtu", "force.msh"})
    for (const char* field : {"displacement_mm", "rotation_rad", "axial_force_N", "moment_z_Nmm"})
      EXPECT_NE(contents(folder / "out" / name).find(field), std::string::npos) << name << " " << field;
}

TEST(FrameProgram, ElementSizeDividesMembersAndChangesNoAnswer) {
  const Folder folder;
  const std::string frame = written(folder, file);
  for (const char* size : {"", " --element-size '30 mm'"})
    ASSERT_EQ(deflect("frame " + frame + size + " --json '" + (folder / (*size ? "b" : "a")).string() + "' --out '" +
                      (folder / (*size ? "fine" : "coarse")).string() + "'")
                  .code,
              0);
  const json a = json::parse(contents(folder / "a")), b = json::parse(contents(folder / "b"));
  for (const char* name : {"own weight", "force"})
    for (const char* key : {"ux_mm", "uz_mm", "ry_rad"}) {
      const double one = a["cases"][name]["displacements"][2][key], many = b["cases"][name]["displacements"][2][key];
      EXPECT_NEAR(one, many, 1e-9 * std::abs(one) + 1e-15) << name << key;
    }
  EXPECT_GT(contents(folder / "fine" / "force.vtu").size(), 2 * contents(folder / "coarse" / "force.vtu").size());
}

TEST(FrameProgram, SolvesAPublishedCaseByItsName) {
  const auto run = deflect("frame logan-5-30");
  ASSERT_EQ(run.code, 0) << run.out;
  EXPECT_NE(run.out.find("-169.336"), std::string::npos) << run.out;  // −6.666757 in
  const auto portal = deflect("frame ansys-vm217");
  EXPECT_NE(portal.out.find("3.18031e+09 Nmm  at 10160 mm"), std::string::npos)
      << portal.out;  // 28148148 lb in, middle
}

TEST(FrameProgram, SameCallSameBytes) {
  const Folder folder;
  for (const char* name : {"a", "b"})
    ASSERT_EQ(deflect("frame sap2000-1-001 --json '" + (folder / name).string() + "'").code, 0);
  EXPECT_EQ(contents(folder / "a"), contents(folder / "b"));
}

TEST(FrameProgram, LongListsAreCutToTheLargest) {
  const auto run = deflect("frame sap2000-1-001");
  EXPECT_NE(run.out.find("member forces in member axes, N and Nmm, the 24 largest of 70"), std::string::npos)
      << run.out;
}

struct Refusal {
  const char* name;
  const char *old_text, *new_text, *options;
  int code;
  const char* says;

  friend void PrintTo(const Refusal& r, std::ostream* out) { *out << r.new_text << r.options; }
};

class FrameRefused : public ::testing::TestWithParam<Refusal> {};

TEST_P(FrameRefused, WithCodeAndReasonAndNoFile) {
  const Folder folder;
  std::string text = file;
  const std::string old_text = GetParam().old_text;
  if (!old_text.empty()) text.replace(text.find(old_text), old_text.size(), GetParam().new_text);
  const auto run = deflect("frame " + written(folder, text) + " " + GetParam().options + " --json '" +
                           (folder / "r.json").string() + "'");
  EXPECT_EQ(run.code, GetParam().code) << run.out;
  EXPECT_NE(run.out.find(GetParam().says), std::string::npos) << run.out;
  EXPECT_FALSE(std::filesystem::exists(folder / "r.json"));
}

INSTANTIATE_TEST_SUITE_P(
    Inputs, FrameRefused,
    ::testing::Values(Refusal{"Unit", "300 mm", "300", "", 2, "frame.yaml:9: nodes.tip.0: '300' has no unit"},
                      Refusal{"Node", "to: tip", "to: tipp", "", 2,
                              "frame.yaml:12: members.arm.to: unknown node 'tipp', did you mean 'tip'?"},
                      Refusal{"ElementUnit", "", "", "--element-size 25", 2, "--element-size: '25' has no unit"},
                      Refusal{"ElementNegative", "", "", "--element-size '-1 mm'", 2, "greater than zero"},
                      Refusal{"Folder", "", "", "--out /proc/none", 2, "/proc/none"},
                      Refusal{"Mechanism", "foot: clamped", "foot: pinned", "", 3, "cannot stand"}),
    [](const auto& refusal) { return std::string(refusal.param.name); });

TEST(FrameProgram, ARedundantConstraintIsSolvedAndNamed) {
  const Folder folder;
  std::string text = file;
  const std::string old_text = "constraints:\n";
  text.replace(text.find(old_text), old_text.size(), old_text + "  still: {terms: [{node: foot, freedom: uz}]}\n");
  const auto run = deflect("frame " + written(folder, text));
  EXPECT_EQ(run.code, 0);
  EXPECT_NE(run.out.find("note: constraint 'still' is redundant: 'support foot uz'"), std::string::npos) << run.out;
}

TEST(FrameProgram, UnknownNameOffersTheNearest) {
  const auto run = deflect("frame logan-5-31");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.out.find("did you mean 'logan-5-30'?"), std::string::npos) << run.out;
}

TEST(FrameProgram, HelpHasAnExample) {
  const auto run = deflect("frame --help");
  EXPECT_EQ(run.code, 0);
  EXPECT_NE(run.out.find("Example:\n  deflect frame"), std::string::npos) << run.out;
}

}  // namespace
}  // namespace deflect
