// `deflect frame` on files whose geometry is not linear.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.h"

namespace deflect {
namespace {

using nlohmann::json;
using test::contents;
using test::deflect;
using test::Folder;

TEST(FrameGeometryProgram, ReportsThePathAndLeavesOutTheChecksOfTheLinearTheory) {
  const Folder folder;
  const auto run = deflect("frame ansys-vm136 --json '" + (folder / "r.json").string() + "' --out '" +
                           (folder / "out").string() + "'");
  ASSERT_EQ(run.code, 0) << run.out;
  for (const char* phrase : {"geometry: finite", "steps, ", "iterations", "axes of the section there"})
    EXPECT_NE(run.out.find(phrase), std::string::npos) << phrase << "\n" << run.out;
  EXPECT_EQ(run.out.find("reciprocity"), std::string::npos);
  const json r = json::parse(contents(folder / "r.json"));
  EXPECT_EQ(r["geometry"], "finite");
  EXPECT_FALSE(r.contains("reciprocity"));
  const json& c = r["cases"]["60 deg"];
  EXPECT_TRUE(c["path"]["converged"] && c["path"]["stable"]);
  EXPECT_GE(c["path"]["steps"], 10);
  EXPECT_FALSE(c["checks"].contains("energy"));
}

TEST(FrameGeometryProgram, BucklingIsANumericalFailureWithItsLoad) {
  const Folder folder;
  const std::string path = (folder / "frame.yaml").string();
  std::ofstream(path) << R"(name: strut
geometry: second-order
materials: {steel: {E: 200 GPa, nu: 0.25}}
sections: {rod: {shape: round, diameter: 10 mm}}
nodes: {a: [0 mm, 0 mm, 0 mm], b: [0 mm, 0 mm, 1000 mm]}
members: {rod: {from: a, to: b, section: rod, material: steel, elements: 4}}
supports: {a: clamped}
loads: {press: {nodes: {b: {fz: -1 kN}}}}
)";
  const auto run = deflect("frame '" + path + "'");
  EXPECT_EQ(run.code, 4) << run.out;
  EXPECT_NE(run.out.find("load case 'press': the load is beyond the first buckling load"), std::string::npos)
      << run.out;
}

}  // namespace
}  // namespace deflect
