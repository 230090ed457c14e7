// Published frames, from their files in validation/cases through the reader and the analysis. A tolerance is half a
// unit of the last printed digit unless a test says otherwise.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/frames.h"
#include "tests/support/paths.h"

namespace deflect {
namespace {

using test::case_file;
using test::inch;
using test::kip;
using test::lbf;
using test::Solved;

void expect_checks_hold(const Solved& s) { EXPECT_EQ(frame::failed_check(s.result), "") << s.frame.name; }

TEST(Frames, EveryFileOfAPublishedCaseNamesItsSourceAndHoldsItsChecks) {
  std::size_t files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(test::source_dir()) / "validation/cases")) {
    const Solved s(case_file(entry.path().stem().string()));
    EXPECT_NE(s.frame.source, "") << entry.path();
    EXPECT_EQ(s.frame.name, entry.path().stem().string());
    for (const frame::CaseResult& c : s.result.cases) {
      EXPECT_LT(c.checks.residual, 1e-11) << entry.path();
      EXPECT_LT(c.checks.equilibrium, 1e-9) << entry.path();
      EXPECT_LT(c.checks.energy, 1e-9) << entry.path();
    }
    EXPECT_LT(s.result.reciprocity, 1e-9) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 8u);
}

// Displacements in in and rad to the eight digits of a second program; Logan prints fewer.
TEST(Frames, LoganExample58) {
  const Solved s(case_file("logan-5-8"));
  const double expected[] = {7.0982576e-5, -1.3995135e-2, -2.3518893e-3, -3.9960904e-3, 1.7800692e-5, -1.0334290e-4};
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(s.u("N1")(i) / (i < 3 ? inch : 1), expected[i], 0.51e-7 * std::abs(expected[i])) << i;
}

TEST(Frames, LoganProblem530) {
  const Solved s(case_file("logan-5-30"));
  const Vector6& left = s.reaction("N1");
  EXPECT_NEAR(left(0) / kip, 11.6877, 0.51e-4);
  EXPECT_NEAR(left(1) / kip, 30, 1e-9);
  EXPECT_NEAR(left(5) / (kip * inch), -1810.0745, 0.51e-4);
  EXPECT_NEAR(s.u("N3")(1) / inch, -6.666757, 0.51e-6);
  EXPECT_NEAR(s.u("N4")(1), s.u("N3")(1), 1e-9 * std::abs(s.u("N3")(1)));
}

TEST(Frames, Frame3ddExampleBWithItsSelfWeight) {
  const Solved s(case_file("frame3dd-b"));
  const Vector6& apex = s.u("1");
  EXPECT_NEAR(1e3 * apex(0), 0.01412722, 0.51e-8);
  EXPECT_NEAR(1e3 * apex(1), -0.05022766, 0.51e-8);
  EXPECT_NEAR(1e3 * apex(2), -0.02237403, 0.51e-8);
  EXPECT_NEAR(apex(3), 3.59e-5, 0.51e-7);
  EXPECT_NEAR(apex(4), 8.1e-6, 0.51e-7);
  // Printed: equivalent nodal loads in N and Nmm to three decimals.
  const frame::CaseLoad load =
      frame::load_of(s.frame, s.result.structure, s.frame.loads[0].first, s.frame.loads[0].second);
  const double signs[][2] = {{-1, 1}, {-1, -1}, {1, -1}, {1, 1}};  // of the moments about x and y at the feet
  EXPECT_NEAR(load.forces(2), -109.992, 0.51e-3);
  for (int foot = 0; foot < 4; ++foot) {
    const Vector6 f = load.forces.segment<6>(6 * (foot + 1));
    EXPECT_NEAR(f(2), -2.498, 0.51e-3);
    EXPECT_NEAR(1e3 * f(3), signs[foot][0] * 374.698, 0.51e-3);
    EXPECT_NEAR(1e3 * f(4), signs[foot][1] * 499.598, 0.51e-3);
  }
  // Reactions carry 4 · 36 mm² · 1802.776 mm · 7.85e-6 kg/mm³ · 9.80633 m/s² and the force.
  double lift = 0;
  for (const Vector6& r : s.result.cases[0].reactions) lift += r(2);
  EXPECT_NEAR(lift, 100 + 4 * 36 * 1802.775638 * 7.85e-6 * 9.80633, 1e-7);
}

TEST(Frames, Sap2000Example1SevenStoreys) {
  const Solved s(case_file("sap2000-1-001"));
  EXPECT_NEAR(s.u("L7")(0) / inch, 1.450757, 0.51e-6);
  const Vector6& foot = s.member("column L1").start;
  EXPECT_NEAR(foot(0) / kip, 69.98673, 0.51e-5);  // the left column is pulled
  EXPECT_NEAR(std::abs(foot(5)) / (kip * inch), 2324.6773, 0.51e-4);
  for (int floor = 1; floor <= 7; ++floor)
    for (const char* column : {"M", "R"})
      EXPECT_NEAR(s.u(fmt::format("{}{}", column, floor))(0), s.u(fmt::format("L{}", floor))(0), 1e-15);
}

TEST(Frames, AnsysVm41RigidArmOnASpring) {
  const Solved s(case_file("ansys-vm41"));
  EXPECT_NEAR(s.u("tip")(1) / inch, -0.1, 1e-14);
  EXPECT_NEAR(s.u("tip")(5), -0.01, 1e-15);
  EXPECT_NEAR(s.result.cases[0].springs[0](5) / (lbf * inch), 100, 1e-10);
  EXPECT_NEAR(s.result.cases[0].energy / (lbf * inch), 0.5, 1e-13);  // ½ · 10 lb · 0.1 in
}

TEST(Frames, AnsysVm21WithoutTension) {
  const Solved s(case_file("ansys-vm21"));
  EXPECT_NEAR(s.u("middle")(2) / inch, -0.3824064, 0.51e-7);
  EXPECT_NEAR(s.u("left")(4), 0.0061185, 0.51e-7);
  EXPECT_NEAR(s.member("left half").end(5) / (lbf * inch), 8962.65, 0.51e-2);
}

/// PR³ [π/4EI + (3π/4 − 2)/GJ], from the moment PR sin φ and the torque PR(1 − cos φ); units of the file.
double curved_bar_in() {
  const double I = pi / 4, E = 30e6, G = E / 2.6;
  return 50 * 1e6 * (pi / (4 * E * I) + (3 * pi / 4 - 2) / (G * 2 * I));
}

std::string curved_bar(int facets) {
  std::string nodes, members;
  for (int i = 0; i <= facets; ++i) {
    const double angle = pi / 2 * i / facets;
    nodes += fmt::format("  {}: [{} in, {} in, 0 in]\n", i, 100 * std::cos(angle), 100 * std::sin(angle));
    if (i > 0) members += fmt::format("  f{}: {{from: {}, to: {}, section: bar, material: steel}}\n", i, i - 1, i);
  }
  return fmt::format(
      "name: arc\nmaterials:\n  steel: {{E: 30e6 psi, nu: 0.3}}\nsections:\n  bar: {{shape: round, diameter: 2 in}}\n"
      "nodes:\n{}members:\n{}supports:\n  0: clamped\nloads:\n  tip: {{nodes: {{{}: {{fz: -50 lbf}}}}}}\n",
      nodes, members, facets);
}

TEST(Frames, AnsysVm18FacetsConvergeToTheArcWithTheSquareOfTheirNumber) {
  const double exact = curved_bar_in();
  EXPECT_NEAR(exact, 2.64930, 0.51e-5);  // printed
  double previous = 0;
  for (const int facets : {4, 8, 16, 32, 64, 128}) {
    const Solved s(frame::parse_frame(curved_bar(facets), "arc"));
    const double error = exact + s.u(std::to_string(facets))(2) / inch;
    if (previous != 0) {
      EXPECT_NEAR(std::log2(previous / error), 2, 2.4 / (facets * facets)) << facets;
    }
    previous = error;
  }
  EXPECT_LT(std::abs(previous), 1e-4 * exact);
  const Solved file(case_file("ansys-vm18"));
  EXPECT_NEAR(-file.u("18")(2) / inch, 2.64930, 2.64930 * 0.002);
}

// Hoff: β = w a³/27 E I, M = 19 w a²/54 for a = 400 in and members that keep their length.
TEST(Frames, AnsysVm217PortalUnderALineLoad) {
  const frame::FrameDescription f = case_file("ansys-vm217");
  const Solved s(f);
  const double beta = 500 * std::pow(400, 3) / (27 * 30e6 * 20300), M = 19.0 / 54 * 500 * 400 * 400;
  EXPECT_NEAR(s.u("B")(4), beta, 1e-11 * beta);  // about +y: the beam's left end turns down
  EXPECT_NEAR(s.u("C")(4), -beta, 1e-11 * beta);
  const frame::LargestMoment& middle = s.member("beam").Mz;
  EXPECT_NEAR(middle.value / (lbf * inch), M, 1e-9 * M);
  EXPECT_NEAR(middle.at / inch, 400, 1e-6);

  // Areas of 1e6 in² instead of the constraints, by a second program to all digits.
  frame::FrameDescription stout = f;
  stout.constraints.clear();
  for (auto& [name, section] : stout.sections) std::get<GivenSection>(section.shape).A = 1e6 * inch * inch;
  const Solved t(stout);
  EXPECT_NEAR(t.u("B")(4), 1.9461179e-3, 0.51e-10);
  EXPECT_NEAR(t.member("beam").Mz.value / (lbf * inch), 28148156, 0.51);
}

// --- what must not change the answer

struct Unit {
  const char* length;
  double metres;
};

std::string cantilever_in(const Unit& unit) {
  const auto l = [&](double metres) { return fmt::format("{:.17g} {}", metres / unit.metres, unit.length); };
  return fmt::format(
      "name: same\nmaterials:\n  steel: {{E: 200 GPa, nu: 0.3}}\nsections:\n  rod: {{shape: tube, outer_diameter: {}, "
      "inner_diameter: {}}}\nnodes:\n  a: [{}, {}, {}]\n  b: [{}, {}, {}]\n  c: [{}, {}, {}]\nmembers:\n  one: {{from: "
      "a, to: b, section: rod, material: steel, beam: timoshenko}}\n  two: {{from: b, to: c, section: rod, material: "
      "steel}}\nsupports:\n  a: clamped\nloads:\n  tip:\n    nodes: {{c: {{fx: 3 N, fy: -5 N, fz: 7 N}}}}\n    "
      "members: "
      "{{two: {{qy: 2 N/m}}}}\n",
      l(0.0381), l(0.0254), l(0), l(0), l(0), l(0.762), l(0), l(0.254), l(0.762), l(0.508), l(0.254));
}

TEST(Frames, TheUnitsOfTheFileDoNotMatter) {
  const Solved reference(frame::parse_frame(cantilever_in({"m", 1}), "m"));
  for (const Unit& unit : {Unit{"mm", 1e-3}, {"in", inch}, {"ft", 12 * inch}, {"um", 1e-6}}) {
    const Solved s(frame::parse_frame(cantilever_in(unit), unit.length));
    EXPECT_LT((s.u("c") - reference.u("c")).norm(), 1e-12 * reference.u("c").norm()) << unit.length;
    EXPECT_LT((s.reaction("a") - reference.reaction("a")).norm(), 1e-11 * reference.reaction("a").norm())
        << unit.length;
  }
}

TEST(Frames, DivisionChangesOnlyTheRounding) {
  for (const char* name : {"logan-5-30", "frame3dd-b", "ansys-vm217"}) {
    const frame::FrameDescription f = case_file(name);
    const Solved one(f);
    frame::FrameOptions options;
    options.division.assign(f.members.size(), {0, 0.1, 0.35, 0.75, 1});
    const Solved many(f, options);
    expect_checks_hold(many);
    const frame::CaseResult &a = one.result.cases[0], &b = many.result.cases[0];
    for (std::size_t i = 0; i < f.nodes.size(); ++i)
      EXPECT_LT((a.displacements[i] - b.displacements[i]).norm(), 1e-9 * (a.u.norm() + 1e-12)) << name << i;
    for (std::size_t i = 0; i < f.members.size(); ++i) {
      const double size = a.members[i].start.norm() + a.members[i].end.norm();
      EXPECT_LT((a.members[i].start - b.members[i].start).norm(), 1e-8 * size) << name << i;
      EXPECT_LT((a.members[i].end - b.members[i].end).norm(), 1e-8 * size) << name << i;
      EXPECT_NEAR(a.members[i].Mz.value, b.members[i].Mz.value, 1e-8 * size) << name << i;
      EXPECT_NEAR(a.members[i].energy, b.members[i].energy, 1e-8 * a.energy) << name << i;
    }
  }
}

}  // namespace
}  // namespace deflect
