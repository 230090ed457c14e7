// Files for other programs: geometry, fields and the enlarged shape fit together.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "tests/support/program.h"

namespace deflect {
namespace {

using test::contents;
using test::Folder;

/// The numbers of a data array of a .vtu file.
std::vector<double> array(const std::string& vtu, const std::string& name) {
  const std::size_t at = vtu.find("Name=\"" + name + "\"");
  if (at == vtu.npos) return {};
  const std::size_t from = vtu.find('>', at) + 1;
  std::istringstream in(vtu.substr(from, vtu.find("</DataArray>", from) - from));
  std::vector<double> values;
  for (double v; in >> v;) values.push_back(v);
  return values;
}

double sum(const std::vector<double>& v, std::size_t component) {
  double s = 0;
  for (std::size_t i = component; i < v.size(); i += 3) s += v[i];
  return s;
}

TEST(Export, VtkHoldsShapeFieldsForcesAndTheEnlargedShape) {
  const Folder folder;
  const auto run = test::deflect(
      "export haptic-6psu --to vtk --pose 25,25,198.9,0,0,0 --load 50,0,-10,0,200,0 --scale 30 --element-size '20 mm' "
      "-o '" +
      (folder / "m.vtu").string() + "'");
  ASSERT_EQ(run.code, 0) << run.out;
  const std::string plain = contents(folder / "m.vtu"), moved = contents(folder / "m-deflected.vtu");
  const std::vector<double> p = array(plain, "points_mm"), q = array(moved, "points_mm"),
                            u = array(plain, "displacement_mm");
  ASSERT_GT(p.size(), 100u);
  ASSERT_EQ(p.size(), q.size());
  ASSERT_EQ(p.size(), u.size());
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_NEAR(q[i], p[i] + 30 * u[i], 1e-9);
  EXPECT_EQ(array(moved, "displacement_mm"), u);

  // Load and reaction balance, the moment about the base origin too.
  const std::vector<double> f = array(plain, "applied_force_N"), m = array(plain, "applied_moment_Nmm"),
                            rf = array(plain, "reaction_force_N"), rm = array(plain, "reaction_moment_Nmm");
  const double force[] = {50, 0, -10}, moment[] = {0, 200, 0}, at[] = {25, 25, 198.9};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(sum(f, k), force[k]);
    EXPECT_EQ(sum(rf, k), -force[k]);
    EXPECT_EQ(sum(m, k), moment[k]);
    const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
    EXPECT_NEAR(sum(rm, k), -(moment[k] + at[a] * force[b] - at[b] * force[a]), 1e-9);
  }

  const std::vector<double> leg = array(plain, "leg"), part = array(plain, "part"),
                            axial = array(plain, "axial_force_N");
  ASSERT_EQ(leg.size(), axial.size());
  ASSERT_EQ(part.size(), axial.size());
  EXPECT_EQ(std::set<double>(leg.begin(), leg.end()), (std::set<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(std::set<double>(part.begin(), part.end()), (std::set<double>{0, 1, 2}));
  const std::vector<double> group = array(plain, "group");
  EXPECT_EQ(std::set<double>(group.begin(), group.end()).size(), 18u) << "guideway, link and arms of six legs";
}

TEST(Export, MshComesWithOptionsThatShowTheDeflectedShape) {
  const Folder folder;
  const auto run = test::deflect(
      "export haptic-6psu-ideal-joints --to msh --joints 80,80,80,80,80,80 --load 50,0,0 --scale auto --out '" +
      (folder / "out").string() + "'");
  ASSERT_EQ(run.code, 0) << run.out;
  const std::string msh = contents(folder / "out" / "haptic-6psu-ideal-joints.msh");
  for (const char* says : {"\"leg 1 guideway\"", "\"leg 6 link\"", "\"displacement_mm\"", "\"applied_force_N\"",
                           "\"axial_force_N\"", "\"leg\""})
    EXPECT_NE(msh.find(says), std::string::npos) << says;
  const std::string options = contents(folder / "out" / "haptic-6psu-ideal-joints.msh.opt");
  EXPECT_NE(options.find("View[0].VectorType = 5;"), std::string::npos);
  EXPECT_NE(options.find("View[0].DisplacementFactor = 200;"), std::string::npos)
      << "0.0841 mm as some 8 % of the machine's size: " << options;
  EXPECT_NE(contents(folder / "out" / "haptic-6psu-ideal-joints-deflected.msh").find("\"leg 1 guideway\""),
            std::string::npos);
}

TEST(Export, WithoutLoadNothingMoves) {
  const Folder folder;
  ASSERT_EQ(test::deflect("export haptic-6psu --to vtk -o '" + (folder / "m.vtu").string() + "'").code, 0);
  EXPECT_EQ(contents(folder / "m.vtu"), contents(folder / "m-deflected.vtu"));
}

struct Refusal {
  const char* name;
  const char* arguments;
  int code;
  const char* says;
};

class ExportRefused : public ::testing::TestWithParam<Refusal> {};

TEST_P(ExportRefused, WithCodeAndReason) {
  const auto run = test::deflect(std::string("export haptic-6psu ") + GetParam().arguments);
  EXPECT_EQ(run.code, GetParam().code) << run.out;
  EXPECT_NE(run.out.find(GetParam().says), std::string::npos) << run.out;
}

INSTANTIATE_TEST_SUITE_P(
    Inputs, ExportRefused,
    ::testing::Values(Refusal{"Calculix", "--to calculix -o x.inp", 2, "write msh (Gmsh) or vtk (ParaView)"},
                      Refusal{"NoFormat", "-o x.vtu", 2, "--to"}, Refusal{"NoFile", "--to vtk", 2, "either -o FILE"},
                      Refusal{"Both", "--to vtk -o x.vtu --out y", 2, "either -o FILE"},
                      Refusal{"Suffix", "--to vtk -o x.vtk", 2, "ends in .vtu"},
                      Refusal{"ZeroScale", "--to vtk -o x.vtu --scale 0", 2, "greater than zero"},
                      Refusal{"WordScale", "--to vtk -o x.vtu --scale big", 2, "auto or a factor"},
                      Refusal{"NanScale", "--to vtk -o x.vtu --scale nan", 2, "not a finite number"},
                      Refusal{"PoseAndJoints", "--to vtk -o x.vtu --pose 0,0,170 --joints 1,2,3,4,5,6", 2,
                              "either --pose"},
                      Refusal{"OutOfReach", "--to vtk -o x.vtu --pose 300,0,170", 3, "the link does not reach"},
                      Refusal{"UnwritableVtk", "--to vtk -o /proc/none/x.vtu", 2, "/proc/none"},
                      Refusal{"UnwritableMsh", "--to msh -o /proc/none/x.msh", 2, "/proc/none"}),
    [](const auto& refusal) { return std::string(refusal.param.name); });

}  // namespace
}  // namespace deflect
