// What holds of every mechanism: random ones, with branches, coupled springs, contacts under preload, misfits.
#include <gtest/gtest.h>

#include "analytic/model.h"
#include "msa/base/stiffness_checks.h"
#include "tests/support/mechanisms.h"

namespace deflect::analytic {
namespace {

class AnyMechanism : public ::testing::TestWithParam<unsigned> {
 protected:
  void SetUp() override {
    for (PlacedLeg& leg : contacts.legs)
      leg.misfit << test::random_vector(random, 2e-5), test::random_vector(random, 1e-4);
  }
  Configuration linear = test::random_mechanism(GetParam()), contacts = test::random_mechanism(GetParam(), true);
  std::mt19937 random{GetParam()};
  Vector6 F = test::random_wrench(random);
};

TEST_P(AnyMechanism, StiffnessIsSymmetricAndPositive) {
  for (const Configuration& c : {linear, contacts}) {
    const AnalyticModel model(c);
    const AnalyticSolution s = model.solve(F);
    ASSERT_TRUE(s.converged) << s.iterations << " " << s.misfit;
    const Matrix6 K = model.stiffness(s), C = model.compliance(s);
    std::vector<LegStiffness> legs;
    for (std::size_t i = 0; i < model.chains().size(); ++i)
      legs.push_back({model.chains()[i].name, model.leg_stiffness(i, s), model.chains()[i].J_q});
    EXPECT_EQ(check_stiffness(K, legs).failure, "");
    const Vector6 eigen = Eigen::SelfAdjointEigenSolver<Matrix6>(C).eigenvalues();
    EXPECT_GT(eigen(0), 0);
    EXPECT_LE((K * C - Matrix6::Identity()).norm(), 1e-13 * eigen(5) / eigen(0));
  }
}

TEST_P(AnyMechanism, EnergyIsHalfTheWork) {
  const AnalyticModel model(linear);
  const AnalyticSolution s = model.solve(F);
  double stored = 0;
  for (const auto& [part, energy] : model.energies(s)) stored += energy;
  EXPECT_NEAR(stored / (F.dot(s.displacement) / 2), 1, 1e-11);
}

// Richardson's rule on central differences: a contact that has nearly lost its load bends within a millinewton.
TEST_P(AnyMechanism, ComplianceIsTheDerivativeOfTheDisplacement) {
  const AnalyticModel model(contacts);
  const Matrix6 C = model.compliance(model.solve(F));
  for (int i = 0; i < 6; ++i) {
    const auto central = [&](double h) {
      const Vector6 dF = h * Vector6::Unit(i);
      return Vector6((model.solve(F + dF).displacement - model.solve(F - dF).displacement) / (2 * h));
    };
    const double h = i < 3 ? 1e-3 : 1e-4;
    const Vector6 slope = (4 * central(h / 2) - central(h)) / 3;
    EXPECT_LE((slope - C.col(i)).norm(), 1e-6 * C.col(i).norm()) << i;
  }
}

TEST_P(AnyMechanism, AxesMakeNoDifference) {
  const Matrix3 R = rotation_from_rpy(0.4, -1.1, 2.0);
  const AnalyticSolution s = AnalyticModel(contacts).solve(F);
  const AnalyticSolution t =
      AnalyticModel(test::moved(contacts, {R, Vector3(1, -2, 0.5), 1})).solve(rotate_twist(R) * F);
  EXPECT_LE((rotate_twist(R) * s.displacement - t.displacement).norm(), 1e-9 * s.displacement.norm());
}

// Lengths in another unit, forces in the same: displacements scale with the lengths, moments with them.
TEST_P(AnyMechanism, UnitsMakeNoDifference) {
  const AnalyticSolution s = AnalyticModel(contacts).solve(F);
  for (const double scale : {1e-3, 39.37, 1e3}) {
    Vector6 G = F;
    G.tail<3>() *= scale;
    Vector6 d =
        AnalyticModel(test::moved(contacts, {Matrix3::Identity(), Vector3::Zero(), scale})).solve(G).displacement;
    d.head<3>() /= scale;
    EXPECT_LE((s.displacement - d).norm(), 1e-9 * s.displacement.norm()) << scale;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, AnyMechanism, ::testing::Range(1u, 21u));

}  // namespace
}  // namespace deflect::analytic
