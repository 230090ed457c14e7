// The quick way of laws that jump, from its first load on, against the general one, on random devices of laws of every
// kind.
#include <gtest/gtest.h>

#include "analytic/model.h"
#include "msa/base/outcome.h"
#include "msa/mechanism/configuration.h"
#include "tests/attack/random_device.h"

namespace deflect::attack {
namespace {

TEST(QuickWay, MovesAsTheGeneralOneDoes) {
  int compared = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    const RandomDevice device = with_nonlinear_laws(random_device(seed));
    const auto found = outcome_of([&] {
      const Configuration c = configure(device.mechanism, home_pose(device.mechanism));
      const analytic::AnalyticModel quick(c), whole(c);
      if (!quick.jumps()) return false;
      const analytic::AnalyticSolution a = quick.displaced(device.load, {}), b = whole.solve(device.load);
      if (!b.converged) return false;
      EXPECT_TRUE(a.converged) << "seed " << seed << ": " << a.message;
      // As the theories where laws are solved to equilibrium.
      Vector6 apart = a.displacement - b.displacement, size = b.displacement;
      apart.tail<3>() *= c.size, size.tail<3>() *= c.size;
      EXPECT_LE(apart.norm(), 1e-7 * size.norm()) << "seed " << seed;
      return true;
    });
    compared += found && *found;
  }
  EXPECT_GT(compared, 60);
}

}  // namespace
}  // namespace deflect::attack
