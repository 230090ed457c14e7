// Preloaded laws that jump, and contacts beside them, next to a pad: by hand and by both theories. From its preloaded
// state a law with δ(f) and U(f) has δ(f + P) − δ(P) and stores U(f + P) − U(P) − P (δ(f + P) − δ(P)).
#include <gtest/gtest.h>

#include <cmath>

#include "analytic/model.h"
#include "msa/frame/mechanism/msa.h"
#include "tests/support/mechanisms.h"

namespace deflect {
namespace {

constexpr double pad = 2e5;  // N/m

/// A platform on a pad that yields to all, beside a seat of these laws along z.
Configuration beside_a_pad(const std::vector<Law>& laws, double preload) {
  PlacedJoint seat = test::joint("seat", Vector3::Zero(), "ffrfff");
  seat.laws[2] = laws;
  seat.preload[2] = preload;
  const PlacedJoint spring =
      test::spring("pad", Vector3::Zero(), {{0, 1e6}, {1, 1e6}, {2, pad}, {3, 1e3}, {4, 1e3}, {5, 1e3}});
  return test::configuration(Vector3::Zero(), {{"seat", {seat}}, {"pad", {spring}}}, 0.1);
}

/// Displacement along z, stiffness and the energy stored in the seat under a force along z.
struct AlongZ {
  double d, K, seat;
};

double of_seat(const std::vector<std::pair<std::string, double>>& energies) {
  for (const auto& [part, energy] : energies)
    if (part.find("seat") != part.npos) return energy;
  ADD_FAILURE() << "no seat";
  return 0;
}

AlongZ by_closed_form(const Configuration& c, double force) {
  const analytic::AnalyticModel model(c);
  const analytic::AnalyticSolution s = model.solve(force * Vector6::Unit(2));
  EXPECT_TRUE(s.converged) << s.message;
  return {s.displacement(2), model.stiffness(s)(2, 2), of_seat(model.energies(s))};
}

AlongZ by_msa(const Configuration& c, double force) {
  frame::MsaModel model(c);
  const frame::MsaSolution s = model.solve(force * Vector6::Unit(2));
  EXPECT_TRUE(s.state.converged) << s.state.message;
  return {s.displacement(2), model.stiffness(s.state).K(2, 2), of_seat(s.energies)};
}

/// The laws are solved to 1e-11 of the forces, and energies are differences of some ten times their size.
void expect(const AlongZ& found, const AlongZ& by_hand, const std::string& about) {
  EXPECT_NEAR(found.d, by_hand.d, 1e-9 * std::abs(by_hand.d)) << about;
  EXPECT_NEAR(found.K, by_hand.K, 1e-8 * by_hand.K) << about;
  EXPECT_NEAR(found.seat, by_hand.seat, 1e-8 * by_hand.seat) << about;
}

// The contact of point and plane has δ = a f^{2/3} and stores 2/5 f δ; the seat yields to pull and to push differently.
TEST(PreloadedSteps, AContactBesideALawOfTwoSidesIsAsByHand) {
  const HertzPointLaw ball{"", 0.004, {210e9, 0.3, {}}};
  const OneSidedLaw sides{1e-6, 3e-6};
  const double a = analytic::point_contact_deflection(0.004, 210e9 / 0.91, 1);
  const auto contact = [&](double f) { return std::copysign(a * std::pow(std::abs(f), 2.0 / 3), f); };
  const auto side = [&](double f) { return (f < 0 ? 3e-6 : 1e-6) * f; };
  const auto stored = [&](double f) { return 0.4 * f * contact(f) + f * side(f) / 2; };
  for (const double P : {20.0, -12.0}) {
    const Configuration c = beside_a_pad({sides, ball}, P);
    for (const double f : {5.0, 40.0, -8.0, -31.0}) {
      const double at = f + P, d = contact(at) + side(at) - contact(P) - side(P);
      const double yields = 2.0 / 3 * contact(at) / at + side(at) / at;
      const AlongZ by_hand{d, pad + 1 / yields, stored(at) - stored(P) - P * d};
      const std::string about = std::to_string(P) + " N, " + std::to_string(f) + " N";
      expect(by_closed_form(c, f + pad * d), by_hand, "closed form, " + about);
      expect(by_msa(c, f + pad * d), by_hand, "MSA, " + about);
    }
  }
}

// It sticks with its stiffness until it carries its limit, of which the preload is a part; then the pad takes the rest.
TEST(PreloadedSteps, AFrictionSlipsSoonerTheWayItIsPreloaded) {
  constexpr double k = 1e6, limit = 10, P = 4;
  const Configuration c = beside_a_pad({FrictionLaw{limit, k}}, P);
  for (const double force : {3.0, -3.0, 7.0, 20.0, -16.0, -40.0}) {
    const double sticking = force / (k + pad), f = std::clamp(k * sticking, -limit - P, limit - P);
    const bool sticks = f == k * sticking;
    const double d = sticks ? sticking : (force - f) / pad;
    for (const AlongZ& found : {by_closed_form(c, force), by_msa(c, force)}) {
      EXPECT_NEAR(found.d, d, 1e-9 * std::abs(d)) << force;
      EXPECT_NEAR(found.K, sticks ? k + pad : pad, 1e-8 * k) << force;
    }
  }
}

}  // namespace
}  // namespace deflect
