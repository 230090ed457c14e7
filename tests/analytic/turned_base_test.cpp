// The closed form in the deformed shape: what legs carry and resist on a base that turns.
#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

#include "analytic/model.h"
#include "analytic/rotation_vector.h"
#include "tests/support/mechanisms.h"

namespace deflect::analytic {
namespace {

/// A hexapod of legs of that stiffness, N/m, on a base with springs in these freedoms.
Configuration on_a_soft_base(double leg, const std::vector<std::pair<std::size_t, double>>& base) {
  std::mt19937 random(5);
  std::vector<PlacedLeg> legs;
  for (const auto& [foot, head] : test::hexapod(random)) legs.push_back(test::strut("leg", foot, head, leg));
  Configuration c = test::configuration(Vector3(0, 0, 0.42), legs, 0.5);
  c.base = test::spring("base", Vector3::Zero(), base);
  return c;
}

// Whatever the base yields, the legs carry the load: [f; m] at T, in base axes.
TEST(Deformed, TheLegsOnASoftBaseCarryTheLoad) {
  const Configuration c = on_a_soft_base(1e7, {{0, 1e6}, {2, 1e6}, {3, 2e3}, {4, 1e3}, {5, 3e3}});
  const Vector6 F = (Vector6() << 60, -40, 90, 5, -8, 12).finished();
  for (const Geometry geometry : {Geometry::second_order, Geometry::finite}) {
    const AnalyticSolution s = AnalyticModel(c).solve(F, geometry);
    ASSERT_TRUE(s.converged) << s.message;
    EXPECT_GT(s.displacement.tail<3>().norm(), 5e-3);  // else all axes are alike
    Vector6 sum = Vector6::Zero();
    for (const Vector6& w : s.leg_wrenches) sum += w;
    EXPECT_LE((sum - F).norm(), 1e-9 * F.norm()) << static_cast<int>(geometry);
  }
}

// Legs on a base that turned by θ turn with it. Second order counts rotations by the rotation vector, of which a spin
// is J times the change, and has all this to the first order in θ: half the load leaves a quarter of the difference.
TEST(Deformed, StiffnessesOfLegsTurnWithTheirBase) {
  const Configuration c = on_a_soft_base(1e9, {{3, 2e3}, {4, 3e3}});
  const AnalyticModel model(c);
  const Vector6 F = (Vector6() << 200, -240, 0, 0, 0, 0).finished();
  const auto difference = [&](double share, std::size_t leg) {
    const AnalyticSolution second = model.solve(share * F, Geometry::second_order),
                           finite = model.solve(share * F, Geometry::finite);
    EXPECT_TRUE(second.converged && finite.converged);
    EXPECT_GT(finite.displacement.tail<3>().norm(), share * 0.05);
    Matrix6 counted = Matrix6::Identity();
    counted.bottomRightCorner<3, 3>() = RotationChange(finite.displacement.tail<3>()).J;
    const Matrix6 K = counted.transpose() * model.leg_stiffness(leg, finite) * counted;
    return (model.leg_stiffness(leg, second) - K).norm() / K.norm();
  };
  for (std::size_t leg = 0; leg < c.legs.size(); ++leg) {
    EXPECT_LT(difference(1, leg), 0.01) << leg;
    EXPECT_GT(difference(1, leg), 3.5 * difference(0.5, leg)) << leg;
  }
}

}  // namespace
}  // namespace deflect::analytic
