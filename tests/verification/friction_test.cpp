// Friction and play by hand: one straight column of springs, by both theories.
#include <gtest/gtest.h>

#include "analytic/model.h"
#include "msa/frame/mechanism/msa.h"
#include "tests/support/mechanisms.h"

namespace deflect {
namespace {

constexpr double k_s = 2e5, k = 8e5, F_c = 30;  // N/m, N/m, N

/// A joint with one law along z, all else rigid: a leg from the ground to T.
PlacedLeg column(const std::string& name, const std::vector<Law>& laws) {
  PlacedJoint j = test::joint(name, Vector3::Zero(), "rrrrrr");
  j.laws[2] = laws;
  return {name, {j}};
}

/// A leg that guides T along z: rigid in all else. Beside it the others yield in z only and are free in all else.
Configuration side_by_side(const std::vector<std::pair<std::string, std::vector<Law>>>& springs) {
  std::vector<PlacedLeg> legs = {{"guide", {test::joint("guide", Vector3::Zero(), "rrfrrr")}}};
  for (const auto& [name, laws] : springs) {
    PlacedJoint j = test::joint(name, Vector3::Zero(), "fffffr");
    j.freedoms[5] = Freedom::free;
    j.laws[2] = laws;
    legs.push_back({name, {j}});
  }
  return test::configuration(Vector3(0, 0, 0.1), legs, 0.1);
}

Vector6 along_z(double N) { return N * Vector6::Unit(2); }

struct Answer {
  double z, stored, tangent;
  std::vector<double> slips;
};

double total(const std::vector<std::pair<std::string, double>>& energies) {
  double sum = 0;
  for (const auto& [part, energy] : energies) sum += energy;
  return sum;
}

/// By the closed form and by the MSA, which must agree to rounding.
Answer answer(const Configuration& c, double N, const Conditions& conditions = {}) {
  const analytic::AnalyticModel analytic(c);
  frame::MsaModel msa(c);
  const analytic::AnalyticSolution a = analytic.solve(along_z(N), conditions);
  const frame::MsaSolution f = msa.solve(along_z(N), conditions);
  EXPECT_TRUE(a.converged) << a.message;
  EXPECT_TRUE(f.state.converged) << f.state.message;
  EXPECT_NEAR(a.displacement(2), f.displacement(2), 1e-12 * (std::abs(N) / k_s + F_c / k));
  EXPECT_NEAR(total(analytic.energies(a)), total(f.energies), 1e-11 * F_c * (std::abs(N) / k_s + F_c / k));
  EXPECT_EQ(a.slips.size(), f.slips.size());
  for (std::size_t i = 0; i < a.slips.size(); ++i)
    EXPECT_NEAR(a.slips[i], f.slips[i], 1e-12 * (std::abs(N) / k_s + F_c / k));
  return {a.displacement(2), total(analytic.energies(a)), 1 / analytic.compliance(a)(2, 2), a.slips};
}

const Configuration jenkins() {
  return side_by_side({{"spring", {LinearLaw{k_s}}}, {"friction", {FrictionLaw{F_c, k}}}});
}

// A spring k_s beside a Jenkins element (k, F_c): it loads with k_s + k until z = F_c/k, then with k_s; unloads with
// k_s + k until the friction has turned round, over 2 F_c/k. Over a whole cycle between ±z the friction wastes
// 4 F_c (z − F_c/k), its slip there and back.
TEST(Jenkins, LoadsSlipsAndUnloadsAsByHand) {
  const Configuration c = jenkins();
  const double slips_at = F_c / k, N_slip = (k_s + k) * slips_at;
  const Answer low = answer(c, N_slip / 2);
  EXPECT_NEAR(low.z, N_slip / 2 / (k_s + k), 1e-15);
  EXPECT_NEAR(low.tangent / (k_s + k), 1, 1e-12);
  EXPECT_EQ(low.slips, std::vector<double>{0});
  EXPECT_NEAR(low.stored / ((k_s + k) * low.z * low.z / 2), 1, 1e-12);

  const double N = 3 * N_slip;
  const Answer high = answer(c, N);
  EXPECT_NEAR(high.z / ((N - F_c) / k_s), 1, 1e-12);
  EXPECT_NEAR(high.tangent / k_s, 1, 1e-12);
  EXPECT_NEAR(high.slips.at(0) / (high.z - slips_at), 1, 1e-12);
  EXPECT_NEAR(high.stored / (k_s * high.z * high.z / 2 + F_c * F_c / (2 * k)), 1, 1e-12);

  Conditions after;
  after.slips = high.slips;
  const Answer less = answer(c, N - N_slip, after);
  EXPECT_NEAR((N_slip / (high.z - less.z)) / (k_s + k), 1, 1e-10);
  EXPECT_EQ(less.slips, high.slips);
  EXPECT_GT(answer(c, 0, after).z, 0);  // it stays where friction holds it
}

TEST(Jenkins, LoopHasTheAreaOfFourTimesForceAndSlip) {
  const Configuration c = jenkins();
  const double N = 5 * (k_s + k) * F_c / k;
  Conditions at;
  double area = 0, z_before = 0, N_before = 0, z_most = 0;
  // From rest to N, and then once round.
  const int steps = 400;
  for (int i = 0; i <= 5 * steps / 4; ++i) {
    const double now = N * std::sin(2 * pi * i / steps);
    const Answer a = answer(c, now, at);
    at.slips = a.slips;
    z_most = std::max(z_most, a.z);
    if (i > steps / 4) area += (now + N_before) / 2 * (a.z - z_before);  // exact where all is straight between
    z_before = a.z;
    N_before = now;
  }
  EXPECT_NEAR(area / (4 * F_c * (z_most - F_c / k)), 1, 1e-3);
}

TEST(Jenkins, WithoutForceOrWithAllIsAsWithoutItOrWithASpring) {
  const auto with = [](double force, double stiffness) {
    return answer(side_by_side({{"spring", {LinearLaw{k_s}}}, {"friction", {FrictionLaw{force, stiffness}}}}), 50).z;
  };
  EXPECT_NEAR(with(1e-12, k) / (50 / k_s), 1, 1e-12);
  EXPECT_NEAR(with(0, k) / (50 / k_s), 1, 1e-12);
  EXPECT_NEAR(with(1e9, k) / (50 / (k_s + k)), 1, 1e-12);
  EXPECT_NEAR(with(F_c, 1e12) / ((50 - F_c) / k_s), 1, 1e-9);  // rigid before it slips
}

TEST(Friction, InSeriesCannotCarryMoreThanItsForce) {
  const Configuration c = test::configuration(Vector3(0, 0, 0.1), {column("friction", {FrictionLaw{F_c, k}})}, 0.1);
  EXPECT_NEAR(answer(c, 0.9 * F_c).z / (0.9 * F_c / k), 1, 1e-12);
  const analytic::AnalyticSolution a = analytic::AnalyticModel(c).solve(along_z(1.1 * F_c));
  EXPECT_FALSE(a.converged);
  EXPECT_NE(a.message.find("slips at 30"), std::string::npos) << a.message;
  const frame::MsaSolution f = frame::MsaModel(c).solve(along_z(1.1 * F_c));
  EXPECT_FALSE(f.state.converged);
  EXPECT_NE(f.state.message.find("slips at 30 N"), std::string::npos) << f.state.message;
}

TEST(Clearance, ClosesBesideASpringAndThenHolds) {
  const double gap = 1e-4;
  const Configuration c = side_by_side({{"spring", {LinearLaw{k_s}}}, {"stop", {ClearanceLaw{gap}, LinearLaw{k}}}});
  for (const double sign : {1.0, -1.0}) {
    EXPECT_NEAR(answer(c, sign * 0.5 * k_s * gap).z / (sign * 0.5 * gap), 1, 1e-12);
    const double N = 5 * k_s * gap;
    EXPECT_NEAR(answer(c, sign * N).z / (sign * (gap + (N - k_s * gap) / (k_s + k))), 1, 1e-12);
  }
  EXPECT_EQ(answer(c, 0).z, 0);
}

TEST(Clearance, AloneIsTravelledUnderAnyLoadAndNotWithout) {
  const double gap = 1e-4;
  const Configuration c =
      test::configuration(Vector3(0, 0, 0.1), {column("gap", {ClearanceLaw{gap}, LinearLaw{k}})}, 0.1);
  for (const double N : {1e-6, 1.0, 1e6, -3.0})
    EXPECT_NEAR(answer(c, N).z, N / k + std::copysign(gap, N), 1e-12 * (gap + std::abs(N) / k)) << N;
  const analytic::AnalyticModel analytic(c);
  EXPECT_TRUE(analytic.solve(along_z(0)).displacement.isZero(0));
  EXPECT_TRUE(frame::MsaModel(c).solve(along_z(0)).displacement.isZero(0));
}

TEST(OneSided, HasItsComplianceOnOneSide) {
  const Configuration c =
      test::configuration(Vector3(0, 0, 0.1), {column("rope", {OneSidedLaw{1e-6, {}}, LinearLaw{k}})}, 0.1);
  EXPECT_NEAR(answer(c, 10).z, 10 * (1e-6 + 1 / k), 1e-16);
  EXPECT_NEAR(answer(c, -10).z, -10 / k, 1e-16);
}

// A clamped joint with play: its preload keeps it closed on one side, beyond the preload it crosses over.
TEST(Preload, KeepsAClearanceClosed) {
  const double gap = 1e-4;
  PlacedLeg leg = column("gap", {ClearanceLaw{gap}, LinearLaw{k}});
  std::get<PlacedJoint>(leg.parts[0]).preload[2] = 20;
  const Configuration c = test::configuration(Vector3(0, 0, 0.1), {leg}, 0.1);
  EXPECT_NEAR(answer(c, -10).z, -10 / k, 1e-15);
  EXPECT_NEAR(answer(c, 10).z, 10 / k, 1e-15);
  EXPECT_NEAR(answer(c, -30).z, -30 / k - 2 * gap, 1e-15);
}

}  // namespace
}  // namespace deflect
