// Lattices solved by conjugate gradients. Corner (0, 0, top) of n = 10 and n = 20 in mm, as other programs compute it
// with Euler–Bernoulli beams (CalculiX U1, OpenSees); half of the last digit given.
#include <gtest/gtest.h>

#include "tests/support/frames.h"
#include "tests/support/lattice.h"

namespace deflect::frame {
namespace {

Vector3 corner(const FrameResult& r, int n) {
  return 1e3 * r.cases[0].displacements[static_cast<std::size_t>(n * n * (n - 1))].head<3>();
}

TEST(LargeFrames, CornerOfTenCubedByEitherWay) {
  const FrameDescription f = test::lattice(10);
  for (const Equations solver : {Equations::direct, Equations::iterative}) {
    const FrameResult r = analyse(f, {{}, {solver}});
    EXPECT_EQ(r.equations.solver, equations_names[static_cast<std::size_t>(solver)]);
    EXPECT_EQ(r.equations.freedoms, 5400);
    EXPECT_NEAR(corner(r, 10).x(), 0.11577764, 0.51e-8);
    EXPECT_NEAR(corner(r, 10).y(), 0, 1e-10);
    EXPECT_NEAR(corner(r, 10).z(), 0.00066204466, 0.51e-11);
    EXPECT_EQ(failed_check(r), "");
  }
}

TEST(LargeFrames, CornerOfTwentyCubedWithTheWayThatIsChosen) {
  const FrameResult r = analyse(test::lattice(20));
  EXPECT_EQ(r.equations.solver, "iterative") << r.equations.why;
  EXPECT_EQ(r.equations.freedoms, 45600);
  ASSERT_TRUE(r.equations.error_bound.has_value());
  EXPECT_LE(*r.equations.error_bound, 1e-10);
  EXPECT_NEAR(corner(r, 20).x(), 0.24446206, 0.51e-8);
  EXPECT_NEAR(corner(r, 20).y(), 0, 1e-10);
  EXPECT_NEAR(corner(r, 20).z(), 0.0026698374, 0.51e-10);
  EXPECT_EQ(failed_check(r), "");
}

}  // namespace
}  // namespace deflect::frame
