// Both theories in the deformed shape, on every built-in device.
//
// Second order: both write equilibrium in the undeformed shape, but the closed form takes the forces of members from
// statics there and the MSA from its displacements, and stretched levers count in it between groups of parts and not in
// members; finite: the law of a member leaves out the third order. Either way the displacements differ by an order of
// the load more than the deformed shape changes them. What the MSA's elements add falls with their number.
#include <gtest/gtest.h>

#include "analytic/model.h"
#include "msa/frame/mechanism/msa.h"
#include "tests/support/chains.h"
#include "tests/support/mechanisms.h"
#include "validation/studies/solve.h"

namespace deflect {
namespace {

using namespace studies;

/// |a − b| / |b|, rotations weighed by a length.
double difference(const Vector6& a, const Vector6& b, double length) {
  Vector6 w = Vector6::Ones();
  w.tail<3>().setConstant(length);
  return w.cwiseProduct(a - b).norm() / w.cwiseProduct(b).norm();
}

Configuration inextensible(Configuration c) {
  for_each_part(c.legs, [](auto& part) {
    if constexpr (requires { part.section; }) part.section.A *= 100;
  });
  return c;
}

class DeformedDevice : public ::testing::TestWithParam<std::string> {
 protected:
  DeformedDevice() : mechanism(test::device(GetParam())), c(configure(mechanism, home_pose(mechanism))) {}

  static std::vector<Vector6> loads() {
    std::vector<Vector6> all;
    for (int i = 0; i < 3; ++i) all.push_back(50 * Vector6::Unit(i));
    Vector6 mixed;
    mixed << 30, -25, 31, 0.5, -1, 0.75;
    all.push_back(mixed);
    return all;
  }

  Mechanism mechanism;
  Configuration c;
};

/// The condition of a beam of n elements grows as n⁴: 2⁻⁵² · 16⁴, four times over for the sums of legs and theories.
constexpr double rounding = 4 * 2.2e-16 * 65536;

/// By the MSA with 8 and 16 elements in each member, whose errors fall by 4, and what these leave taken off.
Vector6 refined(const Configuration& c, const Vector6& F, Geometry geometry) {
  const auto by = [&](int elements) {
    const frame::MsaSolution s = frame::MsaModel(c, frame::equal_division(c, elements)).solve(F, geometry);
    EXPECT_TRUE(s.state.converged);
    return s.displacement;
  };
  return (4 * by(16) - by(8)) / 3;
}

/// What the theories say of each other and of the linear answer under F, F/2 and F/4.
struct Comparison {
  std::vector<double> of_theories, from_linear;

  Comparison(const Configuration& c, const Vector6& F, Geometry geometry) {
    const analytic::AnalyticModel a(c);
    for (const double share : {1.0, 0.5, 0.25}) {
      const analytic::AnalyticSolution s = a.solve(share * F, geometry);
      EXPECT_TRUE(s.converged) << s.message;
      of_theories.push_back(difference(s.displacement, refined(c, share * F, geometry), c.size));
      from_linear.push_back(difference(s.displacement, a.solve(share * F).displacement, c.size));
    }
  }
};

// Members are exact to the fourth order of their bending and divided until what that leaves is 1e-6 of the
// displacement: at any load the theories differ by no more. Of what the deformed shape changes they say the same to 0.2
// %.
TEST_P(DeformedDevice, FiniteAgreesToWhatDividingMembersLeaves) {
  for (const Vector6& F : loads()) {
    const Comparison x(c, F, Geometry::finite);
    for (const double apart : x.of_theories) EXPECT_LE(apart, 1e-6) << F;
    EXPECT_LE(x.of_theories[0], 2e-3 * x.from_linear[0] + rounding);
  }
}

// The second order of a serial machine with a parallel stage differs in the first order of the load by the stretch of
// its members: half at half the load, 1 % of the change. That it is the stretch is shown by members that cannot: there
// the theories are ten times closer. All others as above, contacts, whose stiffness goes with the cube root of the
// load, with a fifth for the next term.
TEST_P(DeformedDevice, SecondOrderDiffersByOneOrderMoreThanItChanges) {
  for (const Vector6& F : loads()) {
    const Comparison x(c, F, Geometry::second_order);
    const Comparison stiff(inextensible(c), F, Geometry::second_order);
    const bool stretch = stiff.of_theories[0] < 0.1 * x.of_theories[0], contacts = !analytic::AnalyticModel(c).linear();
    for (std::size_t i = 1; i < 3; ++i)
      EXPECT_LE(x.of_theories[i], x.of_theories[i - 1] / (stretch ? 1.8 : contacts ? 3.2 : 3.5) + rounding) << F;
  }
}

// What each theory leaves out of the second order is no disagreement.
TEST_P(DeformedDevice, IsAnsweredInTheDeformedShape) {
  for (const Geometry geometry : {Geometry::second_order, Geometry::finite})
    for (const Vector6& F : loads())
      EXPECT_NO_THROW(solve(mechanism, {mm_deg_from(c.pose), c}, wrench_in_mm(F), {}, geometry));
}

// Devices that turn by 0.01 rad at most; the others move by more, and their theories differ by more of the change.
class StiffDevice : public DeformedDevice {};

TEST_P(StiffDevice, SecondOrderAgreesToASmallShareOfTheChange) {
  for (const Vector6& F : loads()) {
    const Comparison x(c, F, Geometry::second_order), stiff(inextensible(c), F, Geometry::second_order);
    const bool stretch = stiff.of_theories[0] < 0.1 * x.of_theories[0];
    EXPECT_LE(x.of_theories[0], (stretch ? 1e-2 : 2e-3) * x.from_linear[0] + rounding);
  }
}

// Elements of half the length, a quarter of the error, with an eighth left for the next term; where fourth powers
// prevail, less.
TEST_P(StiffDevice, TheMsaSettlesAsItsElementsAreRefined) {
  for (const Geometry geometry : {Geometry::second_order, Geometry::finite})
    for (const Vector6& F : loads()) {
      std::vector<Vector6> d;
      for (const int elements : {4, 8, 16})
        d.push_back(frame::MsaModel(c, frame::equal_division(c, elements)).solve(F, geometry).displacement);
      EXPECT_LE((d[1] - d[2]).norm(), (d[0] - d[1]).norm() / 3.5 + rounding * d[2].norm());
    }
}

struct Stiffnesses {
  double apart, change;  // of the theories, and by the load's stresses

  Stiffnesses(const Configuration& c, const Vector6& F, Geometry geometry) {
    const analytic::AnalyticModel a(c);
    frame::MsaModel f(c, frame::equal_division(c, 16));
    const Matrix6 of_a = a.stiffness(a.solve(F, geometry)), linear = a.stiffness(a.solve(F));
    apart = test::stiffness_difference(of_a, f.stiffness(f.solve(F, geometry).state).K, c.size);
    change = test::stiffness_difference(of_a, linear, c.size);
  }
};

// Stiffness by both theories, the stresses of the load in it, to a share of what these change, and its own rounding.
// Where members' stretch parts the theories, as above, a larger share.
TEST_P(StiffDevice, StiffnessAgreesAsTheDisplacementDoes) {
  for (const Geometry geometry : {Geometry::second_order, Geometry::finite})
    for (const Vector6& F : loads()) {
      const Stiffnesses s(c, F, geometry);
      if (s.apart <= 2e-3 * s.change + 2e-10) continue;
      const Stiffnesses stiff(inextensible(c), F, geometry);
      EXPECT_LE(stiff.apart, 0.1 * s.apart + 2e-10);
      EXPECT_LE(s.apart, 5e-2 * s.change + 2e-10);
    }
}

std::string name_of(const testing::TestParamInfo<std::string>& device) {
  std::string name = device.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Devices, DeformedDevice, ::testing::ValuesIn(test::device_names()), name_of);
INSTANTIATE_TEST_SUITE_P(Devices, StiffDevice,
                         ::testing::Values("haptic-6psu", "haptic-6psu-ideal-joints", "stewart-6ups", "delta",
                                           "fanuc-r2000ic", "hybrid", "tripteron"),
                         name_of);

/// A stiffness of all six freedoms at a joint turns with it, as its laws do: a column on a spring that lets it tilt,
/// kθ = F L cos θ + P L sin θ in finite geometry and kθ = (F + Pθ) L in second order.
TEST(CoupledJoint, LetsAColumnTiltUnderItsLoad) {
  const Mechanism m = parse_mechanism(R"(
name: column
kinematics: {family: chains}
leg:
  foot: {joint: fixed, stiffness: {units: N-mm, rows: [
    [1e9, 0, 0, 0, 0, 0], [0, 1e9, 0, 0, 0, 0], [0, 0, 1e9, 0, 0, 0],
    [0, 0, 0, 1e6, 0, 0], [0, 0, 0, 0, 1e6, 0], [0, 0, 0, 0, 0, 1e6]]}}
  end: {offset: [0 mm, 0 mm, 500 mm]}
)",
                                      "column.yaml");
  const Configuration column = configure(m, home_pose(m));
  Vector6 load = Vector6::Zero();
  load(0) = 10, load(2) = -1000;
  const double k = 1000, L = 0.5, second_order = 10 * L / (k - 1000 * L);
  double finite = 0;
  for (int i = 0; i < 60; ++i) finite = (10 * L * std::cos(finite) + 1000 * L * std::sin(finite)) / k;
  for (const auto& [geometry, tilt] : {std::pair{Geometry::second_order, second_order}, {Geometry::finite, finite}}) {
    EXPECT_NEAR(frame::MsaModel(column).solve(load, geometry).displacement(4), tilt, 1e-9) << tilt;
    EXPECT_NEAR(analytic::AnalyticModel(column).solve(load, geometry).displacement(4), tilt, 1e-9) << tilt;
  }
}

/// With stiffnesses between the freedoms, in axes that other joints turn, at every place that takes them.
TEST(CoupledJoint, IsTheSameInBothTheories) {
  const Mechanism arm = test::device("arm");
  const std::string rows = R"(stiffness: {units: N-m, rows: [
      [2e7, 1e6, 5e5, 2e5, 1e5, 3e4], [1e6, 3e7, 2e5, 1e4, -2e5, 1e5], [5e5, 2e5, 1e7, 5e4, 2e4, 1e4],
      [2e5, 1e4, 5e4, 9e3, 5e2, 1e2], [1e5, -2e5, 2e4, 5e2, 7e3, 2e2], [3e4, 1e5, 1e4, 1e2, 2e2, 5e3]]})";
  Vector6 load;
  load << 100, -200, -300, 5, -10, 7.5;
  for (const std::string at : {"leg.joint_1", "leg.joint_4", "base", "tool"}) {
    const std::string kind = at.starts_with("leg") ? "joint: motor, " : "";
    const Mechanism m = test::with(arm, at, "{" + kind + rows + "}");
    VectorX q(6);
    q << 0.3, -0.5, 0.7, 0.9, -0.4, 0.2;
    const Configuration c = configure_joints(m, q);
    const analytic::AnalyticModel a(c);
    const Vector6 linear = a.solve(load).displacement;
    for (const Geometry geometry : {Geometry::linear, Geometry::finite}) {
      const Vector6 d = a.solve(load, geometry).displacement;
      EXPECT_LE(difference(refined(c, load, geometry), d, c.size), 1e-6) << at;
      if (geometry == Geometry::finite) {
        EXPECT_GT(difference(d, linear, c.size), 1e-4) << "the test shows nothing";
      }
    }
  }
}

/// A leg that ends turned by t about x beside its seat carries the platform there: R0 = Rx(t). Its hinge then turns by
/// a = m/k about z, R = Rz(a) Rx(t), so that R R0ᵀ, which the load adds, is a turn about z alone.
TEST(Misfit, TurnsNoAxisOfTheRotationThatTheLoadAdds) {
  const double k = 500, t = 0.04, a = 0.03;
  PlacedLeg leg{"leg", {test::spring("hinge", Vector3::Zero(), {{5, k}})}};
  leg.misfit(3) = t;
  const Configuration c = test::configuration(Vector3::Zero(), {leg}, 1);
  const Vector6 load = k * a * Vector6::Unit(5), right = a * Vector6::Unit(5);
  EXPECT_LE((analytic::AnalyticModel(c).solve(load, Geometry::finite).displacement - right).norm(), 1e-12);
  EXPECT_LE((frame::MsaModel(c).solve(load, Geometry::finite).displacement - right).norm(), 1e-12);
}

}  // namespace
}  // namespace deflect
