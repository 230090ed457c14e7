#include "msa/base/convex_search.h"

#include <gtest/gtest.h>

#include <cmath>

namespace deflect {
namespace {

// ½ x² + ½ k (x − 3)² is least at x = 3 k/(1 + k), where y = x − 3 is known to the rounding of 3 alone.
TEST(ConvexSearch, ComesToRestWhereAStiffRowIsADifferenceOfLargeNumbers) {
  const double k = 1e10;
  ConvexProblem p;
  p.a = VectorX::Ones(1), p.b = VectorX::Zero(1), p.B = MatrixX::Ones(1, 1), p.e = VectorX::Constant(1, -3);
  p.rows.push_back({-HUGE_VAL, HUGE_VAL, [k](double y) { return k * y; }, [k](double) { return k; }});
  for (const double start : {0.0, 1.0 / 3, 3.1}) {
    const ConvexAnswer found = least(p, VectorX::Constant(1, start));
    EXPECT_EQ(found.outcome, ConvexAnswer::Outcome::least);
    EXPECT_NEAR(found.x(0), 3 * k / (1 + k), 1e-15);
  }
}

}  // namespace
}  // namespace deflect
