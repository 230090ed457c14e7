// Published and closed-form answers with the geometry of the displaced structure: buckling loads, tie rods and
// beam-columns (second order), elastica and arcs in space (finite). The cubic element has errors of fourth order in its
// length, so that halving it divides them by 16; what else converges slower says why.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/columns.h"
#include "tests/support/elastica.h"
#include "tests/support/frames.h"

namespace deflect {
namespace {

using frame::GeometricState;
using frame::Model;
using test::buckling_factor;
using test::column;
using test::Elastica;
using test::elastica;
using test::inch;
using test::kip;
using test::lbf;
using test::load_at;
using test::rigid_in_shear;
using test::solve;

/// Errors of successive halvings fall by `factor`, the closer the finer the mesh.
void expect_rate(const std::vector<double>& errors, double factor, double slack) {
  for (std::size_t i = 1; i < errors.size(); ++i)
    EXPECT_NEAR(errors[i - 1] / errors[i], factor, slack * factor / std::pow(2, i)) << i;
}

// --- second order

// L. Euler, 1744: P = π²EI/4L² of a cantilever, about the weaker axis.
TEST(Buckling, EulersColumnConvergesWithTheFourthPower) {
  std::vector<double> errors;
  for (const int n : {1, 2, 4, 8}) {
    const Model m = column(n, 1, {1e6, 2, 1, 1, rigid_in_shear, rigid_in_shear});
    const double P = buckling_factor(m, load_at(m, n, {-1, 0, 0}), 10);
    errors.push_back(P / (pi * pi / 4) - 1);
  }
  EXPECT_GT(errors.back(), 0);  // elements are stiffer than the column
  EXPECT_LT(errors.back(), 2.1e-6);
  expect_rate(errors, 16, 0.2);
}

// F. Engesser, 1891: 1/P = 1/P_E + 1/GA_s. Deflected by transverse forces alone the element has constant shear, the
// buckled column has not: second order.
TEST(Buckling, ShearSoftensTheColumnAfterEngesser) {
  std::vector<double> errors;
  for (const int n : {2, 4, 8, 16}) {
    const Model m = column(n, 1, {1e6, 2, 1, 1, 40, 40});
    const double P = buckling_factor(m, load_at(m, n, {-1, 0, 0}), 10);
    errors.push_back(P * (4 / (pi * pi) + 1.0 / 40) - 1);
  }
  EXPECT_GT(errors.back(), 0);
  EXPECT_LT(errors.back(), 5e-5);
  expect_rate(errors, 4, 0.25);
}

// S. Timoshenko, J. Gere, Theory of Elastic Stability, 1961, §6.3: a deep cantilever under a load at its tip turns
// sideways at P L² = 4.0126 √(EI GJ), twice the first zero of the Bessel function of order −1/4; warping left out.
TEST(Buckling, ADeepCantileverTurnsSideways) {
  std::vector<double> errors;
  for (const int n : {4, 8, 16}) {
    const Model m = column(n, 1, {1e6, 2, 1e4, 0.5, rigid_in_shear, rigid_in_shear});
    const double P = buckling_factor(m, load_at(m, n, {0, -1, 0}), 10);
    errors.push_back(P / 4.0126 - 1);
  }
  EXPECT_GT(errors.back(), 0);
  EXPECT_LT(errors.back(), 1e-3);
  expect_rate(errors, 4, 0.1);
}

TEST(Buckling, IsAResultWithWordsAndNotAnError) {
  const Model m = column(4, 1, {1e6, 2, 1, 1, rigid_in_shear, rigid_in_shear});
  const GeometricState s = solve(m, load_at(m, 4, {-3, 0, 0}), Geometry::second_order);
  EXPECT_TRUE(s.converged);
  EXPECT_FALSE(s.stable);
  EXPECT_NE(s.message.find("beyond the first buckling load"), std::string::npos) << s.message;
}

/// A case of a file with its members in n elements each.
test::Solved divided(const std::string& name, int n) {
  frame::FrameDescription f = test::case_file(name);
  for (auto& [member, data] : f.members) data.elements = n;
  return test::Solved(f);
}

// Ansys VM21 after Timoshenko: with u² = S L²/4EI, w = 5qL⁴/384EI · (1/cosh u − 1 + u²/2)/(5u⁴/24) and
// M = qL²/8 · 2 (cosh u − 1)/(u² cosh u); computed to w = −0.1994529 in, M = 4580.15 lbf in.
TEST(TieRodAnsysVm21, ConvergesToTheDeflectionAndMomentUnderTension) {
  const double E = 30e6, I = std::pow(2.5, 4) / 12, L = 200, q = 1.79253, S = 21972.6;
  const double u = L / 2 * std::sqrt(S / (E * I));
  const double w =
      5 * q * std::pow(L, 4) / (384 * E * I) * (1 / std::cosh(u) - 1 + u * u / 2) / (5 * std::pow(u, 4) / 24);
  const double M = q * L * L / 8 * 2 * (std::cosh(u) - 1) / (u * u * std::cosh(u));
  EXPECT_NEAR(w, 0.1994529, 0.51e-7);
  EXPECT_NEAR(M, 4580.15, 0.51e-2);
  std::vector<double> of_w, of_M;
  for (const int n : {1, 2, 4, 8, 16}) {
    const test::Solved s = divided("ansys-vm21", n);
    of_w.push_back(-s.u("middle", 1)(2) / inch / w - 1);
    of_M.push_back(s.member("left half", 1).end(5) / (lbf * inch) / M - 1);
    // Without tension every mesh is exact.
    EXPECT_NEAR(s.u("middle", 0)(2) / inch, -0.3824064, 0.51e-7);
    EXPECT_NEAR(s.member("left half", 0).end(5) / (lbf * inch), 8962.65, 0.51e-2);
  }
  expect_rate(of_w, 16, 0.2);
  expect_rate(of_M, 16, 0.2);
  EXPECT_LT(std::abs(of_w.back()), 1e-7);
  EXPECT_LT(std::abs(of_M.back()), 1e-6);
}

TEST(BeamColumnAiscDesignGuide25, ConvergesToTipAndMoment) {
  const double E = 29500, I = 2150, L = 196, H = 10, P_cr = pi * pi * E * I / (4 * L * L);
  for (const auto& [index, alpha] : {std::pair{1u, 0.3}, {2u, 0.6}}) {
    const double P = alpha * P_cr, kL = L * std::sqrt(P / (E * I));
    const double tip = H * L * (std::tan(kL) - kL) / (P * kL), M = H * L * std::tan(kL) / kL;
    std::vector<double> of_tip, of_M;
    for (const int n : {1, 2, 4, 8}) {
      const test::Solved s = divided("aisc-dg25", n);
      of_tip.push_back(s.u("top", index)(0) / inch / tip - 1);
      of_M.push_back(-s.reaction("foot", index)(4) / (kip * inch) / M - 1);
    }
    expect_rate(of_tip, 16, 0.35);
    expect_rate(of_M, 16, 0.35);
    EXPECT_LT(std::abs(of_tip.back()), 4e-6) << alpha;
  }
}

// --- finite

struct Printed {
  double ratio, degrees, x, y;  // tip displacements on L = 100: y across, x along, as the manual prints them
};
constexpr Printed vm136[] = {
    {1.152, 60, -25.9, 59.3}, {1.293, 80, -44, 71.9}, {1.518, 100, -65.1, 79.2}, {1.884, 120, -87.7, 80.3}};

// The manual's pairs (59.3, −25.9) … are the tip's displacements across and along the bar: of the elastica whose tip
// turns by 60° … 120°.
TEST(ElasticaAnsysVm136, PrintedValuesAreThoseOfTheEllipticIntegrals) {
  for (const Printed& c : vm136) {
    const double p = std::sin(c.degrees / 2 * pi / 180), K = std::comp_ellint_1(p);
    EXPECT_NEAR(4 * K * K / (pi * pi), c.ratio, 1e-3);  // cut, not rounded
    const Elastica exact = elastica(K * K, 0);
    EXPECT_NEAR(exact.angle * 180 / pi, c.degrees, 1e-6);
    EXPECT_NEAR(100 * (exact.x - 1), c.x, 0.07);
    EXPECT_NEAR(100 * exact.y, c.y, 0.07);
  }
}

TEST(ElasticaAnsysVm136, ConvergesWithTheFourthPower) {
  const double delta = 0.01;  // a force along the bar finds no side to buckle to
  for (const Printed& c : vm136) {
    const double P = c.ratio * pi * pi / 4;
    const Elastica exact = elastica(P, delta);
    std::vector<double> of_angle, of_x, of_y;
    for (const int n : {4, 8, 16}) {
      const Model m = column(n, 1, {1e9, 1, 1, 1, rigid_in_shear, rigid_in_shear});  // shortens by 1e-9 P
      const GeometricState s =
          solve(m, load_at(m, n, P * Vector3(-std::cos(delta), std::sin(delta), 0)), Geometry::finite, 8);
      ASSERT_TRUE(s.converged && s.stable) << s.message;
      of_angle.push_back(s.u(6 * n + 5) - exact.angle);
      of_x.push_back(1 + s.u(6 * n) - exact.x);
      of_y.push_back(s.u(6 * n + 1) - exact.y);
    }
    expect_rate(of_angle, 16, 0.3);
    expect_rate(of_x, 16, 0.3);
    expect_rate(of_y, 16, 0.3);
    EXPECT_LT(std::abs(of_angle.back()), 1e-4) << c.ratio;
  }
}

// The file has twenty elements and a side load of a thousandth: as exact as the elastica under that inclined load.
TEST(ElasticaAnsysVm136, TheFileAgreesWithTheInclinedLoad) {
  const test::Solved s(test::case_file("ansys-vm136"));
  EXPECT_EQ(frame::failed_check(s.result), "");
  for (std::size_t c = 0; c < 4; ++c) {
    const Elastica exact = elastica(vm136[c].ratio * pi * pi / 4 * std::hypot(1, 1e-3), std::atan(1e-3));
    EXPECT_NEAR(s.u("tip", c)(5), exact.angle, 2e-4) << c;
    EXPECT_NEAR(s.u("tip", c)(0) / (100 * inch), exact.x - 1, 2e-4) << c;
    EXPECT_NEAR(s.u("tip", c)(1) / (100 * inch), exact.y, 2e-4) << c;
    EXPECT_NEAR(100 * exact.y, vm136[c].y, 0.5) << c;  // the ratio is rounded to 0.0005: 0.4 % of the rotation at 60°
    // The clamp carries the moment of the forces in the deformed shape.
    const Vector6 reaction = s.reaction("foot", c);
    const double moment = -(100 * inch + s.u("tip", c)(0)) * -reaction(1) + s.u("tip", c)(1) * -reaction(0);
    EXPECT_NEAR(reaction(5), moment, 1e-9 * std::abs(moment)) << c;
  }
}

// A moment bends a cantilever to a circle of the radius R = EI/M, here by three quarters of a turn.
TEST(PureBending, RollsTheCantileverUp) {
  std::vector<double> errors;
  const double turn = 1.5 * pi;
  for (const int n : {4, 8, 16}) {
    const Model m = column(n, 1, {1e7, 1, 1, 1, rigid_in_shear, rigid_in_shear});
    const GeometricState s = solve(m, load_at(m, n, Vector3::Zero(), {0, 0, turn}), Geometry::finite, 4);
    ASSERT_TRUE(s.converged) << s.message;
    errors.push_back(std::hypot(1 + s.u(6 * n) - std::sin(turn) / turn, s.u(6 * n + 1) - (1 - std::cos(turn)) / turn));
  }
  expect_rate(errors, 16, 0.3);
}

// K.-J. Bathe, S. Bolourchi, Large displacement analysis of three-dimensional beam structures, Int. J. Numer. Meth.
// Eng. 14 (1979) 961: an arc of 45°, R = 100, square 1 × 1, E = 1e7, G = 5e6, 600 out of plane at the tip: (−13.4,
// −23.5, 53.4). J. C. Simo, L. Vu-Quoc, Comput. Meth. Appl. Mech. Eng. 58 (1986) 79, eight linear elements, tip under
// 300, 450, 600 at (22.33, 58.84, 40.08), (18.62, 52.32, 48.39), (15.79, 47.23, 53.37). Published answers scatter by
// 0.3 % of the displacement, as does the polygon of eight elements: 1 % of its radius 100/… is the tolerance taken.
TEST(BendOf45Degrees, LiesAmongThePublishedAnswersAndConvergesWithTheFacets) {
  const double E = 1e7, G = 5e6, R = 100;
  std::vector<Vector3> tips;
  for (const int n : {8, 16, 32, 64}) {
    Model m;
    for (int i = 0; i <= n; ++i) {
      const double a = pi / 4 * i / n;
      m.add_node("n", {R * (1 - std::cos(a)), R * std::sin(a), 0});
    }
    for (int i = 0; i < n; ++i) {
      const Vector3 along =
          m.nodes[static_cast<std::size_t>(i) + 1].position - m.nodes[static_cast<std::size_t>(i)].position;
      m.add_beam(i, i + 1, axes_along_x(along, Vector3::UnitZ()), {E, E / 12, E / 12, G / 6, G * 5 / 6, G * 5 / 6},
                 "arc", "arc");
    }
    m.fix(0, "clamp");
    const double published[3][4] = {{300, 22.33, 58.84, 40.08}, {450, 18.62, 52.32, 48.39}, {600, 15.79, 47.23, 53.37}};
    for (const auto& p : published) {
      const GeometricState s = solve(m, load_at(m, n, {0, 0, p[0]}), Geometry::finite, 3);
      ASSERT_TRUE(s.converged && s.stable) << s.message;
      const Vector3 tip = m.nodes.back().position + s.u.segment<3>(6 * n);
      EXPECT_LT((tip - Vector3(p[1], p[2], p[3])).norm(), 0.004 * 59) << n << " " << p[0];
      if (p[0] == 600) tips.push_back(tip);
    }
    EXPECT_LT((tips.back() - m.nodes.back().position - Vector3(-13.4, -23.5, 53.4)).norm(), 0.005 * 59) << n;
  }
  std::vector<double> changes;
  for (std::size_t i = 1; i < tips.size(); ++i) changes.push_back((tips[i] - tips[i - 1]).norm());
  expect_rate(changes, 4, 0.1);  // the polygon is shorter than the arc by the square of its angle
}

}  // namespace
}  // namespace deflect
