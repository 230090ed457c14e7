// A cubic lattice frame: n³ nodes 100 mm apart, nearest neighbours joined by round rods d = 6 mm (E 210 GPa, ν 0.3),
// bottom face clamped, 1 N in x and −1 N in z on each top node. Displacement of the corner (0, 0, top) for
// Euler–Bernoulli rods, as other programs compute it with beams of that kind (CalculiX U1, OpenSees): n = 10:
// (0.11577764, 0, 0.00066204466) mm.
#include <gtest/gtest.h>

#include <limits>

#include "msa/frame/structure/solver.h"
#include "msa/mechanism/sections/section.h"

namespace deflect::frame {
namespace {

Model lattice(int n) {
  const SectionProperties s = properties({RoundSection{0.006}}, 0.3);
  const double E = 210e9, G = E / 2.6, none = std::numeric_limits<double>::infinity();
  const BeamRigidity rod{E * s.A, E * s.Iy, E * s.Iz, G * s.J, none, none};
  Model m;
  const auto index = [n](int x, int y, int z) { return (z * n + y) * n + x; };
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) m.add_node("", 0.1 * Vector3(x, y, z));
  const Matrix3 along[] = {Matrix3::Identity(), axes_along_x(Vector3::UnitY(), Vector3::UnitZ()),
                           axes_along_x(Vector3::UnitZ(), Vector3::UnitX())};
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        if (x + 1 < n) m.add_beam(index(x, y, z), index(x + 1, y, z), along[0], rod, "", "rod");
        if (y + 1 < n) m.add_beam(index(x, y, z), index(x, y + 1, z), along[1], rod, "", "rod");
        if (z + 1 < n) m.add_beam(index(x, y, z), index(x, y, z + 1), along[2], rod, "", "rod");
      }
  for (int i = 0; i < n * n; ++i) m.fix(i, "bottom");
  return m;
}

TEST(Lattice, CornerOfTenCubed) {
  const int n = 10;
  const Model m = lattice(n);
  VectorX load = VectorX::Zero(m.dofs());
  for (int i = n * n * (n - 1); i < n * n * n; ++i) load(6 * i) = 1, load(6 * i + 2) = -1;
  const Solution s = Solver(m).solve(load);
  const Vector3 corner = 1e3 * s.u.segment<3>(6 * n * n * (n - 1));
  EXPECT_NEAR(corner.x(), 0.11577764, 0.51e-8);
  EXPECT_NEAR(corner.y(), 0, 1e-10);
  EXPECT_NEAR(corner.z(), 0.00066204466, 0.51e-11);
}

}  // namespace
}  // namespace deflect::frame
