// Frame files whose geometry is not linear: what is read, and what the analysis says.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "msa/base/error.h"
#include "tests/support/frames.h"

namespace deflect::frame {
namespace {

using test::Solved;

std::string strut(const std::string& geometry, const std::string& loads, const std::string& supports = "a: clamped") {
  return "name: strut\n" + geometry + R"(
materials: {steel: {E: 200 GPa, nu: 0.25, density: 8000 kg/m^3, expansion: 1e-5 1/K}}
sections: {rod: {shape: given, A: 100 mm^2, Iy: 1000 mm^4, Iz: 1000 mm^4, J: 3000 mm^4}}
nodes: {a: [0 mm, 0 mm, 0 mm], b: [1000 mm, 0 mm, 0 mm]}
members: {rod: {from: a, to: b, section: rod, material: steel, elements: 8}}
supports: {)" +
         supports + "}\nloads: {load: " + loads + "}\n";
}

TEST(FrameGeometry, IsReadWrittenAndCheckedWithItsLine) {
  const FrameDescription f = parse_frame(strut("geometry: finite\nload_steps: 7", "{nodes: {b: {fx: 1 N}}}"), "f.yaml");
  EXPECT_EQ(f.geometry, Geometry::finite);
  EXPECT_EQ(f.load_steps, 7);
  EXPECT_EQ(f.members[0].second.elements, 8);
  EXPECT_EQ(write_frame(parse_frame(write_frame(f), "again")), write_frame(f));
  EXPECT_EQ(parse_frame(strut("", "{nodes: {b: {fx: 1 N}}}"), "f.yaml").geometry, Geometry::linear);
  for (const auto& [wrong, message] : {std::pair{"geometry: finit", "did you mean 'finite'"},
                                       {"geometry: finite\nload_steps: 2.5", "not a whole number"},
                                       {"geometry: finite\nload_steps: 0", "load_steps"},
                                       {"load_steps: 3", "goes with 'geometry: finite'"}})
    try {
      parse_frame(strut(wrong, "{nodes: {b: {fx: 1 N}}}"), "f.yaml");
      FAIL() << wrong;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("f.yaml:"), std::string::npos) << e.what();
    }
}

TEST(FrameGeometry, ALoadBeyondBucklingIsAFailedCheckThatSaysSo) {
  const double P_cr = pi * pi * 200 / 4;  // EI = 200 Nm²
  const Solved s(
      parse_frame(strut("geometry: second-order", fmt::format("{{nodes: {{b: {{fx: {} N}}}}}}", -1.01 * P_cr)), "t"));
  EXPECT_FALSE(s.result.cases[0].path.stable);
  EXPECT_NE(failed_check(s.result).find("beyond the first buckling load"), std::string::npos) << failed_check(s.result);
  const Solved below(
      parse_frame(strut("geometry: second-order", fmt::format("{{nodes: {{b: {{fx: {} N}}}}}}", -0.99 * P_cr)), "t"));
  EXPECT_EQ(failed_check(below.result), "");
  const Solved finite(
      parse_frame(strut("geometry: finite", fmt::format("{{nodes: {{b: {{fx: {} N}}}}}}", -1.25 * P_cr)), "t"));
  EXPECT_FALSE(finite.result.cases[0].path.converged);
  EXPECT_NEAR(finite.result.cases[0].path.load_factor, 0.8, 1e-3);
}

// A rod turned by its support hangs where it was turned to; its weight pulls along it. The couples q h²/12 that stand
// for the weight between the nodes keep their direction: at the ends they are not balanced, and bend the rod by q h²
// L/12EI.
TEST(FrameGeometry, ResultsStandInTheDeformedShape) {
  const Solved s(parse_frame(strut("geometry: finite\nload_steps: 4",
                                   "{gravity: [0 m/s^2, 0 m/s^2, -10 m/s^2], temperature: {rod: 10 K}, "
                                   "displacements: {a: {ry: 90 deg}}}"),
                             "t"));
  ASSERT_EQ(failed_check(s.result), "");
  const double weight = 8000 * 1e-4 * 10, EA = 2e7, EI = 200, stretch = weight / (2 * EA) + 1e-4;
  const double couple = weight / (8 * 8 * 12), bent = couple / EI;
  EXPECT_LT((s.u("b").head<3>() - Vector3(-1, 0, -1 - stretch)).norm(), 0.6 * bent);
  EXPECT_NEAR(s.u("b")(4), pi / 2 - bent, 0.02 * bent);
  EXPECT_NEAR(s.member("rod").start(0), weight, 1e-6);
  EXPECT_LT(s.member("rod").start.tail<5>().norm(), 0.01 * couple);
  EXPECT_LT((s.reaction("a") - (Vector6() << 0, 0, weight, 0, 0, 0).finished()).norm(), 0.01 * couple);
  EXPECT_LT(s.result.cases[0].checks.equilibrium, 1e-9);
  EXPECT_GT(s.result.cases[0].path.steps, 3);
}

// A load of which the second order is far below the digits: as in linear geometry, however small, where nodes and ends
// of members have no round coordinates.
TEST(FrameGeometry, NextToNoLoadMovesAsInLinearGeometry) {
  FrameDescription f =
      read_frame(std::filesystem::path(test::source_dir()) / "validation/frames/portal-semi-rigid.yaml");
  for (auto& [name, at] : f.nodes) at += Vector3(3e-4 * std::sin(at.z() + 1), 0, 2e-4 * std::cos(at.x()));
  const Solved linear(f);
  f.geometry = Geometry::finite;
  for (const double factor : {1e-9, 1e-12, 1e-18}) {
    FrameDescription g = f;
    for (auto& [name, load] : g.loads) load.factor = factor;
    const Solved finite(g);
    ASSERT_EQ(failed_check(finite.result), "") << factor;
    for (std::size_t c = 0; c < f.loads.size(); ++c)
      for (const char* node : {"B", "M", "C"})
        EXPECT_LT((finite.u(node, c) / factor - linear.u(node, c)).norm(), 1e-7 * linear.u(node, c).norm())
            << node << " of case " << c << " times " << factor;
  }
}

TEST(FrameGeometry, SpringsOfTheGroundActAlongBaseAxesAtAnyRotation) {
  // Hinged at a and pushed up at b against a spring that acts along z, however far the rod has turned.
  FrameDescription f =
      parse_frame(strut("geometry: finite", "{nodes: {b: {fz: 30 N}}}", "a: [ux, uy, uz, rx, rz]"), "t");
  FrameSpring spring;
  spring.node = "b";
  spring.stiffness[2] = 100;
  f.springs.emplace_back("stay", spring);
  const Solved s(f);
  ASSERT_EQ(failed_check(s.result), "");
  EXPECT_NEAR(s.u("b")(2), 0.3, 1e-9);
  EXPECT_NEAR(s.u("b")(0), std::sqrt(1 - 0.09) - 1, 1e-7);
  EXPECT_NEAR(s.result.cases[0].springs[0](2), -30, 1e-7);
  EXPECT_LT(s.reaction("a").norm(), 1e-6);
}

}  // namespace
}  // namespace deflect::frame
