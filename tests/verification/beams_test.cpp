// Published beam answers, by the frame solver and, where it applies, by the closed form.
#include <gtest/gtest.h>

#include <limits>
#include <ostream>

#include "analytic/member.h"
#include "msa/frame/structure/solver.h"

namespace deflect {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

/// A chain of equal elements along x from a clamped node 0.
frame::Model cantilever(double length, int elements, const frame::BeamRigidity& rigidity) {
  frame::Model m;
  for (int i = 0; i <= elements; ++i) m.add_node("n" + std::to_string(i), {length * i / elements, 0, 0});
  for (int i = 0; i < elements; ++i) m.add_beam(i, i + 1, Matrix3::Identity(), rigidity, "beam", "beam");
  m.fix(0, "clamp");
  return m;
}

// Cantilever of round steel, d = 10 mm, L = 125.5 mm, 50 N across the tip: F L³/3EI = 0.319588 mm, and with the shear
// coefficient 0.9 F L/(κGA) more, 0.320687 mm (elementary beam theory; S. Timoshenko, Strength of Materials I).
struct Theory {
  BeamTheory beam;
  double expected_mm;
  friend void PrintTo(const Theory& t, std::ostream* out) { *out << t.expected_mm << " mm"; }
};

class ShortCantilever : public ::testing::TestWithParam<Theory> {};

TEST_P(ShortCantilever, OneElementIsExactAndMoreChangeNothing) {
  const double L = 0.1255, E = 210e9, nu = 0.3, G = E / (2 * (1 + nu));
  const SectionProperties s = properties({RoundSection{0.010}}, nu);
  const bool shear = GetParam().beam == BeamTheory::timoshenko;
  const frame::BeamRigidity r{
      E * s.A, E * s.Iy, E * s.Iz, G * s.J, shear ? G * s.As_y : none, shear ? G * s.As_z : none};
  for (const int elements : {1, 2, 7, 32}) {
    const frame::Model m = cantilever(L, elements, r);
    for (const int across : {1, 2}) {
      VectorX load = VectorX::Zero(m.dofs());
      load(6 * elements + across) = 50;
      const double tip = 1e3 * frame::Solver(m).solve(load).u(6 * elements + across);
      EXPECT_NEAR(tip, GetParam().expected_mm, 5.1e-7) << elements;  // half a unit of the sixth decimal, published
    }
  }
  PlacedMember member;
  member.p_W_start = Vector3::Zero();
  member.p_W_end = Vector3(L, 0, 0);
  member.R_WM = Matrix3::Identity();
  member.section = s;
  member.E = E;
  member.G = G;
  member.beam = GetParam().beam;
  EXPECT_NEAR(1e3 * 50 * analytic::tip_compliance(member)(1, 1), GetParam().expected_mm, 5.1e-7);
  EXPECT_NEAR(1e3 * 50 * analytic::tip_compliance(member)(2, 2), GetParam().expected_mm, 5.1e-7);
}

INSTANTIATE_TEST_SUITE_P(BothTheories, ShortCantilever,
                         ::testing::Values(Theory{BeamTheory::euler_bernoulli, 0.319588},
                                           Theory{BeamTheory::timoshenko, 0.320687}),
                         [](const auto& theory) {
                           return theory.param.beam == BeamTheory::timoshenko ? "Timoshenko" : "EulerBernoulli";
                         });

// AFNOR SSLL02/89: simply supported short beam, L 1.44 m, A 31e-4 m², I 2810e-8 m⁴, shear coefficient 2.42, E 2e11 Pa,
// ν 0.3, 1e5 N/m. Middle: 5qL⁴/384EI + qL²/8GA' = 9.962135e-4 + 2.630462e-4 = 1.2592597e-3 m. The line load is brought
// to the nodes as qh/2 and ±qh²/12, which leaves the nodes exact.
TEST(ShortBeamAfnorSsll02, MidSpanIsExactForEveryMesh) {
  const double L = 1.44, q = 1e5, E = 2e11, G = E / 2.6, A = 31e-4, I = 2810e-8;
  for (const int elements : {2, 4, 10}) {
    frame::Model m;
    for (int i = 0; i <= elements; ++i) m.add_node("n", {L * i / elements, 0, 0});
    for (int i = 0; i < elements; ++i)
      m.add_beam(i, i + 1, Matrix3::Identity(), {E * A, E * I, E * I, G * I, G * A / 2.42, G * A / 2.42}, "b", "b");
    for (const int dof : {0, 1, 2, 3, 6 * elements + 1, 6 * elements + 2})
      m.constraints.push_back({{{dof, 1}}, 0, "support"});
    VectorX load = VectorX::Zero(m.dofs());
    const double h = L / elements;
    for (int i = 0; i < elements; ++i) {
      load(6 * i + 1) += q * h / 2, load(6 * i + 7) += q * h / 2;
      load(6 * i + 5) += q * h * h / 12, load(6 * i + 11) -= q * h * h / 12;
    }
    const frame::Solution s = frame::Solver(m).solve(load);
    EXPECT_NEAR(s.u(6 * (elements / 2) + 1), 1.2592597e-3, 0.51e-10) << elements;
    const VectorX reactions = constraint_forces(m, eliminate(m), s.fine, load);
    EXPECT_NEAR(reactions(1), -q * L / 2, 1e-6);
    EXPECT_NEAR(reactions(4), -q * L / 2, 1e-6);
  }
}

// D. L. Logan, A First Course in the Finite Element Method, 4th ed., Example 5.8 (kip, in): three members to one node.
TEST(SpaceFrameLoganExample58, DisplacementsOfTheFreeNode) {
  frame::Model m;
  m.add_node("1", Vector3::Zero());
  m.add_node("2", {-100, 0, 0});
  m.add_node("3", {0, 0, -100});
  m.add_node("4", {0, -100, 0});
  const double E = 30000, G = 10000, A = 10, I = 100, J = 50;
  for (const int far : {1, 2, 3}) {
    const Vector3 along = m.nodes[0].position - m.nodes[static_cast<std::size_t>(far)].position;
    const Vector3 reference = far == 1 ? Vector3::UnitY() : Vector3::UnitX();
    m.add_beam(far, 0, axes_along_x(along, reference), {E * A, E * I, E * I, G * J, none, none}, "member", "member");
    m.fix(far, "support " + std::to_string(far + 1));
  }
  VectorX load = VectorX::Zero(m.dofs());
  load(1) = -50;
  load(3) = -1000;
  const frame::Solution s = frame::Solver(m).solve(load);
  const Vector6 expected(
      (Vector6() << 7.0982576e-5, -1.3995135e-2, -2.3518893e-3, -3.9960904e-3, 1.7800692e-5, -1.0334290e-4).finished());
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(s.u(i), expected(i), 0.51e-7 * std::abs(expected(i))) << i;
}

// frame3dd, example B, load case 1 (N, mm): pyramid with shear deformation.
TEST(PyramidFrame3ddExampleB, DisplacementsOfTheApex) {
  frame::Model m;
  m.add_node("1", {0, 0, 1000});
  m.add_node("2", {-1200, -900, 0});
  m.add_node("3", {1200, -900, 0});
  m.add_node("4", {1200, 900, 0});
  m.add_node("5", {-1200, 900, 0});
  const double E = 200000, G = 79300;
  for (const int foot : {1, 2, 3, 4}) {
    const Vector3 along = m.nodes[static_cast<std::size_t>(foot)].position - m.nodes[0].position;
    m.add_beam(0, foot, axes_along_x(along, Vector3::UnitZ()), {E * 36, E * 492, E * 492, G * 1000, G * 20, G * 20},
               "leg", "leg");
    m.fix(foot, "foot " + std::to_string(foot + 1));
  }
  VectorX load = VectorX::Zero(m.dofs());
  load.head<3>() << 100, -200, -109.992;
  const frame::Solution s = frame::Solver(m).solve(load);
  EXPECT_NEAR(s.u(0), 0.01412722, 0.51e-8);
  EXPECT_NEAR(s.u(1), -0.05022766, 0.51e-8);
  EXPECT_NEAR(s.u(2), -0.02237403, 0.0005 / 109.992 * 0.0224);  // fz is printed to six digits
  EXPECT_NEAR(s.u(3), 3.59e-5, 0.51e-7);
  EXPECT_NEAR(s.u(4), 8.1e-6, 0.51e-7);
}

// Ansys VM41: a rigid arm of 10 in on a rotational spring of 10000 in·lb/rad, −10 lb at its tip: −0.1 in, −0.01 rad.
TEST(RigidArmAnsysVm41, TipFollowsTheSpring) {
  frame::Model m;
  const int ground = m.add_node("ground", Vector3::Zero()), arm = m.add_node("arm", Vector3::Zero());
  const int tip = m.add_node("tip", {10, 0, 0});
  m.fix(ground, "ground");
  m.join(arm, tip, "rigid arm");
  std::array<frame::ConnectionFreedom, 6> hinge;
  hinge[5] = {false, {frame::LinearSpring{10000}}};
  m.connect(ground, arm, Vector3::Zero(), Matrix3::Identity(), hinge, "hinge", "hinge");
  VectorX load = VectorX::Zero(m.dofs());
  load(6 * tip + 1) = -10;
  const frame::Solution s = frame::Solver(m).solve(load);
  EXPECT_NEAR(s.u(6 * tip + 1), -0.1, 1e-14);
  EXPECT_NEAR(s.u(6 * tip + 5), -0.01, 1e-15);
}

}  // namespace
}  // namespace deflect
