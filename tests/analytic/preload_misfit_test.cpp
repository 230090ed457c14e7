// Forces without load: preloaded contacts, parts that do not fit, weight.
#include <gtest/gtest.h>

#include "analytic/constraint.h"
#include "analytic/model.h"
#include "tests/support/mechanisms.h"

namespace deflect::analytic {
namespace {

using test::joint;
using test::rod;
using test::spring;

const Law ball = HertzPointLaw{"", 0.004, {210e9, 0.3, {}}};

TEST(Preload, TangentAtRestIsThatOfThePreload) {
  for (const double P : {0.01, 3.0, 50.0, -50.0}) {
    const Spring s{{ball, LinearLaw{4e6}}, P};
    EXPECT_EQ(deflection(s, 0), 0);
    EXPECT_DOUBLE_EQ(compliance(s, 0), point_contact_compliance(0.004, 210e9 / 0.91, P) + 1 / 4e6);
    EXPECT_DOUBLE_EQ(compliance(s, 20), compliance(s.laws, 20 + P));
  }
}

TEST(Preload, VanishesSteadily) {
  const std::vector<Law> laws{ball, LinearLaw{4e6}};
  for (const double P : {1e-2, 1e-4, 1e-6, 0.0}) {
    // δ(f + P) − δ(P) → δ(f) as δ(P) ∝ P^{2/3}
    EXPECT_NEAR(deflection({laws, P}, 20), deflection(laws, 20), 1.01 * deflection(laws, P) + 1e-20) << P;
    EXPECT_NEAR(stored_energy({laws, P}, 20), stored_energy(laws, 20), 1.01 * 20 * deflection(laws, P) + 1e-20) << P;
  }
}

// From far below to far above the preload, across the state without force: dδ = c df, dU = f dδ, to rounding; the
// ratios of 0.01 at which the formula changes included.
TEST(Preload, EnergyIsTheWorkFromThePreloadedState) {
  const Spring s{{ball, LinearLaw{4e6}, HertzLineBulkLaw{"", 0.003, 0.004, 0.01, {210e9, 0.3, {}}}}, 10};
  for (const double f : {1e-9, 1e-5, 0.0999, 0.1001, -0.0999, -0.1001, 5.0, -9.0, -11.0, -30.0, 200.0}) {
    const double h = 1e-4 * std::min(std::abs(f), std::abs(f + 10));
    EXPECT_NEAR((deflection(s, f + h) - deflection(s, f - h)) / (2 * h), compliance(s, f), 1e-7 * compliance(s, f))
        << f;
    EXPECT_NEAR((stored_energy(s, f + h) - stored_energy(s, f - h)) / (2 * h), f * compliance(s, f),
                1e-7 * std::abs(f) * compliance(s, f))
        << f;
    EXPECT_GT(stored_energy(s, f), 0);
  }
  EXPECT_NEAR(stored_energy(s, 1e-9), 0.5e-18 * compliance(s, 0), 1e-9 * 0.5e-18 * compliance(s, 0));
}

TEST(Preload, GivesAMechanismStiffnessAtRest) {
  PlacedJoint contact = spring("contact", Vector3::Zero(), {{0, 1e6}, {1, 1e6}, {3, 1e3}, {4, 1e3}, {5, 1e3}});
  contact.laws[2].push_back(ball);
  contact.preload[2] = 20;
  const AnalyticModel model(test::configuration(Vector3::Zero(), {{"leg", {contact}}}, 0.1));
  const AnalyticSolution rest = model.solve(Vector6::Zero());
  EXPECT_EQ(rest.displacement.norm(), 0);
  EXPECT_NEAR(model.compliance(rest)(2, 2), point_contact_compliance(0.004, 210e9 / 0.91, 20), 1e-18);
  EXPECT_FALSE(model.linear());
  EXPECT_EQ(model.energies(rest)[0].second, 0);
}

// Two rods in line between walls, a gap between them closed by force: gap/(c1 + c2).
TEST(Misfit, ClosedGapBetweenTwoRods) {
  const double gap = 1e-4;
  const PlacedMember left = rod("left", Vector3::Zero(), Vector3(0.3, 0, 0), 0.01);
  const PlacedMember right = rod("right", Vector3(0.8, 0, 0), Vector3(0.3, 0, 0), 0.02);
  PlacedLeg first{"first", {left}}, second{"second", {right}};
  first.misfit = -gap * Vector6::Unit(0);  // too short
  const Configuration c = test::configuration(Vector3(0.3, 0, 0), {first, second}, 0.5);
  EXPECT_EQ(redundant_constraints(c), 6);
  const AnalyticModel model(c);
  const double c1 = 0.3 / (left.E * left.section.A), c2 = 0.5 / (right.E * right.section.A), force = gap / (c1 + c2);
  const AnalyticSolution s = model.assembled();
  ASSERT_TRUE(s.converged);
  EXPECT_NEAR(s.leg_wrenches[0](0) / force, 1, 1e-12);
  EXPECT_NEAR(s.leg_wrenches[1](0) / force, -1, 1e-12);
  EXPECT_NEAR(s.displacement(0) / (-force * c2), 1, 1e-12);
  double stored = 0;
  for (const auto& [part, energy] : model.energies(s)) stored += energy;
  EXPECT_NEAR(stored / (force * gap / 2), 1, 1e-12);
}

// A linear mechanism is displaced by a load as if it fitted, and stores ½ Fᵀd besides what assembly stored.
TEST(Misfit, LinearMechanismsDoNotFeelIt) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Configuration c = test::random_mechanism(seed);
    std::mt19937 random(seed);
    const Vector6 F = test::random_wrench(random);
    const AnalyticSolution fitting = AnalyticModel(c).solve(F);
    c.legs[0].misfit << test::random_vector(random, 1e-4), test::random_vector(random, 1e-3);
    std::get<PlacedParallel>(c.legs[1].parts[2]).branches[1].misfit << test::random_vector(random, 1e-4),
        Vector3::Zero();
    const AnalyticModel model(c);
    const AnalyticSolution s = model.solve(F), assembled = model.assembled();
    ASSERT_TRUE(s.converged && assembled.converged);
    EXPECT_GT(assembled.leg_wrenches[0].norm(), 0.1);
    EXPECT_GT(assembled.displacement.norm(), 1e-6);
    EXPECT_LE((s.displacement - fitting.displacement).norm(), 1e-9 * fitting.displacement.norm());
    Vector6 sum = Vector6::Zero();
    for (const Vector6& w : assembled.leg_wrenches) sum += w;
    EXPECT_LE(sum.norm(), 1e-10 * assembled.leg_wrenches[0].norm());
    double stored = 0;
    for (const auto& [part, energy] : model.energies(s)) stored += energy;
    for (const auto& [part, energy] : model.energies(assembled)) stored -= energy;
    EXPECT_NEAR(stored / (F.dot(s.displacement) / 2), 1, 1e-8);
  }
}

// What is assembled rigidly beside its seat, with nothing that strains, just stands there.
TEST(Misfit, OfAHexapodMovesItsPlatform) {
  std::mt19937 random(9);
  std::vector<PlacedLeg> legs;
  for (const auto& [foot, head] : test::hexapod(random)) legs.push_back(test::strut("leg", foot, head, 1e7));
  const Vector6 misfit = (Vector6() << 1e-4, 2e-4, -1e-4, 1e-3, 0, 2e-3).finished();
  for (PlacedLeg& leg : legs) leg.misfit = misfit;
  const AnalyticSolution s = AnalyticModel(test::configuration(Vector3(0, 0, 0.42), legs, 0.5)).assembled();
  EXPECT_LE((s.displacement - misfit).norm(), 1e-12 * misfit.norm());
  for (const Vector6& w : s.leg_wrenches) EXPECT_LE(w.norm(), 1e-6);
}

TEST(Weight, DisplacesFromTheWeightlessState) {
  Configuration c = test::random_mechanism(2, true);
  const Vector3 weight(0, 0, -40);
  std::mt19937 random(6);
  const Vector6 F = test::random_wrench(random), W = (Vector6() << weight, Vector3::Zero()).finished();
  const AnalyticModel weightless(c);
  c.weight = weight;
  const AnalyticModel heavy(c);
  const AnalyticSolution s = heavy.solve(F), same = weightless.solve(F + W);
  ASSERT_TRUE(s.converged);
  EXPECT_EQ(s.load, F);
  EXPECT_EQ(s.displacement, same.displacement);
  EXPECT_EQ(heavy.stiffness(s), weightless.stiffness(same));
  EXPECT_EQ(heavy.solve(Vector6::Zero()).displacement, weightless.solve(W).displacement);
  EXPECT_EQ(heavy.assembled().displacement.norm(), 0);
}

}  // namespace
}  // namespace deflect::analytic
