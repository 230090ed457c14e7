// Loads along members: against integration of the beam equations, equilibrium, work, and subdivision.
#include "msa/frame/elements/member_loads.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>

#include "msa/frame/file/member_axes.h"

namespace deflect::frame {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

struct Case {
  const char* name;
  BeamRigidity rigidity;

  friend void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
};

class MemberLoads : public ::testing::TestWithParam<Case> {
 protected:
  const double L = 1.7;
  const BeamRigidity r = GetParam().rigidity;
  const ElementLoad load{{310, -420, 530}, 2.5e-4};

  Beam beam() const {
    Beam b;
    b.a = 0, b.b = 1;
    b.R_WM = member_axes({1, 2, -0.5}, {0.3, 0.1, 1});
    b.length = L;
    b.rigidity = r;
    return b;
  }
  static Vector12 in_base(const Beam& b, const Vector12& local) {
    Vector12 d;
    for (int i = 0; i < 12; i += 3) d.segment<3>(i) = b.R_WM * local.segment<3>(i);
    return d;
  }
};

/// Marches u' = N/EA + ε, φ' = M/EI, w' = φ + Q/GAs from end a with the section forces of end a: what a beam does.
/// Returns [u_b; θ_b] for d_a = 0. Polynomials of degree four: Simpson's rule on cubics is exact, so few steps do.
Vector6 march(const BeamRigidity& r, double L, const Vector12& ends, const ElementLoad& load) {
  const int steps = 2000;
  const double h = L / steps;
  Vector6 d = Vector6::Zero();
  const auto rate = [&](double x, const Vector6& at) {
    const Vector6 s = section_forces(ends, load, x);
    Vector6 g;
    g << s(0) / r.EA + load.strain, at(5) + s(1) / r.GAs_y, -at(4) + s(2) / r.GAs_z, s(3) / r.GJ, s(4) / r.EIy,
        s(5) / r.EIz;
    return g;
  };
  for (int i = 0; i < steps; ++i) {  // Runge–Kutta 4
    const double x = i * h;
    const Vector6 k1 = rate(x, d), k2 = rate(x + h / 2, d + h / 2 * k1), k3 = rate(x + h / 2, d + h / 2 * k2),
                  k4 = rate(x + h, d + h * k3);
    d += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return d;
}

TEST_P(MemberLoads, EndForcesSatisfyTheDifferentialEquationsOfTheBeam) {
  Vector12 d = Vector12::Zero();
  d.tail<6>() << 2e-4, -3e-3, 1.5e-3, 4e-3, 2e-3, -1e-3;
  const Beam b = beam();
  const Vector12 ends = end_forces(b, in_base(b, d), load);
  const Vector6 reached = march(r, L, ends, load);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(reached(i), d(6 + i), 1e-12 * d.norm()) << i;
}

TEST_P(MemberLoads, ClampedEndsPushBackWithQLOver2AndQL2Over12) {
  const Vector12 ends = end_forces(beam(), Vector12::Zero(), {{0, 12, 24}, 0});
  const Vector12 expected = (Vector12() << 0, -6 * L, -12 * L, 0, 2 * L * L, -L * L,  //
                             0, -6 * L, -12 * L, 0, -2 * L * L, L * L)
                                .finished();
  EXPECT_LT((ends - expected).norm(), 1e-14 * expected.norm());
  const Vector6 reached = march(r, L, ends, {{0, 12, 24}, 0});
  EXPECT_LT(reached.norm(), 1e-12);
}

TEST_P(MemberLoads, EquivalentForcesHaveTheResultantOfTheLoad) {
  const Vector12 f = equivalent_forces(r, L, load);
  const Vector3 e = Vector3::UnitX();
  EXPECT_LT((f.segment<3>(0) + f.segment<3>(6) - L * load.q_M).norm(), 1e-12 * f.norm());
  const Vector3 moment = f.segment<3>(3) + f.segment<3>(9) + L * e.cross(Vector3(f.segment<3>(6)));
  EXPECT_LT((moment - L * L / 2 * e.cross(load.q_M)).norm(), 1e-12 * f.norm());
}

TEST_P(MemberLoads, SectionForcesReachTheOtherEnd) {
  const Vector12 ends = end_forces(beam(), Vector12::LinSpaced(-1e-3, 2e-3), load);
  EXPECT_LT((section_forces(ends, load, 0) + ends.head<6>()).norm(), 1e-12 * ends.norm());
  EXPECT_LT((section_forces(ends, load, L) - ends.tail<6>()).norm(), 1e-12 * ends.norm());
}

TEST_P(MemberLoads, StationaryMomentsAreWhereTheShearVanishes) {
  const Vector12 ends = end_forces(beam(), Vector12::Zero(), load);
  for (const double x : stationary_moments(ends, load, L)) EXPECT_NEAR(x, L / 2, 1e-12);
  const Vector6 middle = section_forces(ends, load, L / 2);
  EXPECT_NEAR(middle(5), -load.q_M.y() * L * L / 24, 1e-9);  // EI v'' = M; a load along +y bends the middle downwards
  EXPECT_NEAR(middle(4), load.q_M.z() * L * L / 24, 1e-9);
  for (const double x : stationary_moments(ends, {}, L)) EXPECT_EQ(x, -1);
}

TEST_P(MemberLoads, StrainEnergyIsTheIntegralOfSectionForcesAndStrains) {
  Vector12 d = Vector12::Zero();
  d << 1e-4, 2e-3, -1e-3, 3e-3, 1e-3, 2e-3, 5e-4, -2e-3, 1e-3, -1e-3, 2e-3, 1e-3;
  const Beam b = beam();
  const Vector12 d_W = in_base(b, d), ends = end_forces(b, d_W, load);
  const int steps = 200;  // Simpson; the integrand is of degree four, the error far below the tolerance
  double sum = 0;
  for (int i = 0; i <= 2 * steps; ++i) {
    const Vector6 s = section_forces(ends, load, L * i / (2 * steps));
    const double density = s(0) * s(0) / r.EA + s(1) * s(1) / r.GAs_y + s(2) * s(2) / r.GAs_z + s(3) * s(3) / r.GJ +
                           s(4) * s(4) / r.EIy + s(5) * s(5) / r.EIz;
    sum += (i == 0 || i == 2 * steps ? 1 : i % 2 ? 4 : 2) * density / 2 * L / (6 * steps);
  }
  EXPECT_NEAR(strain_energy(b, d_W, load), sum, 1e-9 * sum);
}

TEST_P(MemberLoads, FreeExpansionStoresNothing) {
  Vector12 d = Vector12::Zero();
  d(6) = 1e-3 * L;
  const Beam b = beam();
  const ElementLoad heat{Vector3::Zero(), 1e-3};
  EXPECT_LT(end_forces(b, in_base(b, d), heat).norm(), 1e-12 * r.EA * 1e-3);
  EXPECT_LT(strain_energy(b, in_base(b, d), heat), 1e-20 * r.EA);
}

INSTANTIATE_TEST_SUITE_P(BothTheories, MemberLoads,
                         ::testing::Values(Case{"EulerBernoulli", {2e7, 3e4, 5e4, 2e4, none, none}},
                                           Case{"Timoshenko", {2e7, 3e4, 5e4, 2e4, 4e5, 6e5}}),
                         [](const auto& c) { return std::string(c.param.name); });

TEST(MemberAxes, FollowTheRule) {
  const Vector3 none_given = Vector3::Zero();
  EXPECT_EQ(member_axes({2, 0, 0}, none_given).col(1), Vector3(0, 0, 1));  // y up
  EXPECT_EQ(member_axes({0, 0, 3}, none_given).col(1), Vector3(1, 0, 0));  // vertical: y along the base x
  EXPECT_EQ(member_axes({1e-4, 0, -3}, none_given).col(1).z() > 0, true);  // still vertical
  EXPECT_GT(member_axes({1, 1, 5}, none_given)(2, 1), 0);                  // y on the upper side
  EXPECT_LT((member_axes({1, 0, 0}, {1, 1, 0}).col(1) - Vector3::UnitY()).norm(), 1e-15);
  EXPECT_NEAR(member_axes({1, 2, 3}, {0, 1, 0}).determinant(), 1, 1e-14);
}

}  // namespace
}  // namespace deflect::frame
