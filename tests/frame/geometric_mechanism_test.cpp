// Mechanisms in second order and at finite displacement.
#include <gtest/gtest.h>

#include "msa/frame/mechanism/msa.h"
#include "tests/support/devices.h"

namespace deflect::frame {
namespace {

const MemberDivision two_each = {{"guideway", {0, 0.5, 1}}, {"link", {0, 0.5, 1}}};

class EveryDevice : public ::testing::TestWithParam<const char*> {
 protected:
  Configuration configuration(unsigned seed) const {
    const Mechanism m = test::device(GetParam());
    return configure(m, test::random_poses(m, 1, seed).front());
  }
};

/// Rotations count with a length of the device.
double difference(const Matrix6& A, const Matrix6& B) {
  Vector6 scale;
  scale << 1, 1, 1, 10, 10, 10;
  return (scale.asDiagonal() * (A - B) * scale.asDiagonal()).norm() /
         (scale.asDiagonal() * B * scale.asDiagonal()).norm();
}

Vector6 force_of(double newton, unsigned seed) {
  std::mt19937 random(seed);
  Vector6 F = Vector6::Zero();
  F.head<3>() = newton * test::random_vector(random, 1).normalized();
  return F;
}

// K times the motion between two loads is the difference of the loads. Central differences of 0.1 % of the load, of a
// response that curves by 0.5 % at the full load, and of contacts that stiffen with its cube root: 1e-5 at most.
TEST_P(EveryDevice, FiniteStiffnessIsTheDerivativeOfTheLoadByTheMotion) {
  MsaModel model(configuration(2), two_each);
  const Vector6 F = force_of(50, 4);
  const MsaSolution at = model.solve(F, Geometry::finite);
  ASSERT_TRUE(at.state.converged) << at.state.geometric->message;
  EXPECT_LT(at.state.residual, 1e-12);
  const MsaModel::Stiffness stiffness = model.stiffness(at.state);
  EXPECT_TRUE(stiffness.legs.empty());
  EXPECT_LT(difference(stiffness.K, stiffness.K.transpose()), 1e-12);
  for (int i = 0; i < 6; ++i) {
    const double h = i < 3 ? 0.05 : 0.005;
    const MsaSolution plus = model.solve(F + h * Vector6::Unit(i), Geometry::finite),
                      minus = model.solve(F - h * Vector6::Unit(i), Geometry::finite);
    Vector6 d;
    d.head<3>() = (plus.displacement - minus.displacement).head<3>();
    d.tail<3>() = rotation_vector(rotation_by(plus.displacement.tail<3>()) *
                                  rotation_by(minus.displacement.tail<3>()).conjugate());
    EXPECT_LT((stiffness.K * d / (2 * h) - Vector6::Unit(i)).norm(), 1e-5) << i;
  }
}

// Relative to the linear answer, displacement and stiffness change with the load: a tenth of it, a tenth of the change.
TEST_P(EveryDevice, GeometriesMeetAtSmallLoads) {
  MsaModel model(configuration(3), two_each);
  for (const Geometry geometry : {Geometry::second_order, Geometry::finite}) {
    std::vector<double> of_u, of_K;
    for (const double newton : {50.0, 5.0, 0.5}) {
      const Vector6 F = force_of(newton, 5);
      const MsaSolution linear = model.solve(F), other = model.solve(F, geometry);
      ASSERT_TRUE(other.state.converged) << other.state.geometric->message;
      of_u.push_back((other.displacement - linear.displacement).norm() / linear.displacement.norm());
      of_K.push_back(difference(model.stiffness(other.state).K, model.stiffness(linear.state).K));
    }
    EXPECT_LT(of_u.front(), 0.01);
    for (const auto& changes : {of_u, of_K})
      for (std::size_t i = 1; i < changes.size(); ++i) EXPECT_NEAR(changes[i - 1] / changes[i], 10, 1.2);
  }
  EXPECT_EQ(model.solve(Vector6::Zero(), Geometry::finite).state.geometric, nullptr);
}

TEST_P(EveryDevice, EnergiesAndReactionsBelongToTheState) {
  MsaModel model(configuration(4), two_each);
  const Vector6 F = force_of(50, 6);
  for (const Geometry geometry : {Geometry::second_order, Geometry::finite}) {
    const MsaSolution s = model.solve(F, geometry), linear = model.solve(F);
    double energy = 0, of_linear = 0;
    for (const auto& [part, value] : s.energies) energy += value;
    for (const auto& [part, value] : linear.energies) of_linear += value;
    EXPECT_NEAR(energy, of_linear, 0.02 * of_linear);
    const Vector6 reaction = model.base_reaction(F, s.state);
    EXPECT_LT((reaction + F).head<3>().norm(), 1e-8 * F.norm());
    if (geometry == Geometry::finite) {  // moments balance in the displaced shape
      const Vector3 p = model.model().nodes[static_cast<std::size_t>(model.mechanism().tool)].position +
                        s.displacement.head<3>() -
                        model.model().nodes[static_cast<std::size_t>(model.mechanism().ground)].position;
      EXPECT_LT((reaction.tail<3>() + p.cross(F.head<3>())).norm(), 1e-8 * F.norm());
    }
  }
}

// K u = F in second order. In a serial arm whose joints alone yield, constraints carry all of the force, and no member
// shows in the first step that they turn.
TEST(SecondOrder, WaitsForTheForcesOfConstraints) {
  const Mechanism m = test::device("fanuc-r2000ic");
  MsaModel model(configure(m, home_pose(m)));
  const Vector6 F = 50 * Vector6::Unit(0);
  const MsaSolution s = model.solve(F, Geometry::second_order);
  ASSERT_TRUE(s.state.converged);
  EXPECT_LT((model.stiffness(s.state).K * s.displacement - F).norm(), 1e-11 * F.norm());
  EXPECT_LT(s.state.residual, 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Devices, EveryDevice, ::testing::Values("haptic-6psu-ideal-joints", "haptic-6psu"),
                         [](const auto& name) {
                           return name.param[std::string(name.param).size() - 1] == 's' ? "IdealJoints" : "Contacts";
                         });

}  // namespace
}  // namespace deflect::frame
