// Elements, springs, connections and elimination of the frame solver, against hand-solved cases and the laws that every
// member of a family must keep.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "msa/base/error.h"
#include "msa/frame/structure/solver.h"
#include "tests/support/devices.h"

namespace deflect::frame {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

class EveryBeam : public ::testing::TestWithParam<BeamRigidity> {
 protected:
  Beam beam() const { return {0, 1, axes_along_x({1, 2, 3}, {0, 0, 1}), std::sqrt(14.0) * 0.1, GetParam(), "", ""}; }
};

TEST_P(EveryBeam, StiffnessIsSymmetricAndSemidefinite) {
  const Matrix12 K = stiffness(beam());
  EXPECT_LE((K - K.transpose()).cwiseAbs().maxCoeff(), 1e-15 * K.cwiseAbs().maxCoeff());
  const Vector12 eigenvalues = Eigen::SelfAdjointEigenSolver<Matrix12>(K).eigenvalues();
  EXPECT_GE(eigenvalues(0), -1e-12 * eigenvalues(11));
  EXPECT_GT(eigenvalues(6), 0);  // six rigid motions, no more
}

TEST_P(EveryBeam, RigidMotionCostsNothing) {
  const Beam b = beam();
  const Vector3 along = b.R_WM.col(0) * b.length;
  for (int i = 0; i < 6; ++i) {
    const Vector6 twist = Vector6::Unit(i);
    Vector12 d;
    d << twist, shift_twist(along) * twist;
    EXPECT_LE((stiffness(b) * d).cwiseAbs().maxCoeff(), 1e-13 * stiffness(b).cwiseAbs().maxCoeff()) << i;
  }
}

TEST_P(EveryBeam, TwoElementsInSeriesAreOne) {
  const Beam b = beam();
  Model one, two;
  const Vector3 tip = b.R_WM.col(0) * b.length;
  for (Model* m : {&one, &two}) m->add_node("root", Vector3::Zero());
  one.add_node("tip", tip);
  two.add_node("tip", tip);
  two.add_node("middle", 0.37 * tip);
  one.add_beam(0, 1, b.R_WM, b.rigidity, "", "");
  two.add_beam(0, 2, b.R_WM, b.rigidity, "", "");
  two.add_beam(2, 1, b.R_WM, b.rigidity, "", "");
  for (int i = 0; i < 6; ++i) {
    VectorX tips[2];
    int k = 0;
    for (Model* m : {&one, &two}) {
      if (i == 0) m->fix(0, "root");
      VectorX load = VectorX::Zero(m->dofs());
      load(6 + i) = 1;
      tips[k++] = Solver(*m).solve(load).u.segment<6>(6);
    }
    // The scaled stiffness of two elements has a condition near 1e4: 1e4 times the rounding of a double, with a margin.
    EXPECT_LE((tips[0] - tips[1]).norm(), 1e-11 * tips[0].norm()) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Family, EveryBeam,
                         ::testing::Values(BeamRigidity{1e7, 40, 40, 30, none, none},
                                           BeamRigidity{1e7, 40, 90, 30, none, none},
                                           BeamRigidity{1e7, 40, 40, 30, 3e6, 3e6},
                                           BeamRigidity{1e7, 40, 90, 30, 2e5, 7e4}));

class EverySpring : public ::testing::TestWithParam<SpringLaw> {};

TEST_P(EverySpring, EnergyForceAndTangentAreDerivatives) {
  for (const double d : {-2e-3, -1e-6, 3e-7, 1e-4, 5e-3}) {
    const double h = 1e-5 * std::abs(d);  // central differences: error h²/6 · third derivative ~ 1e-10
    EXPECT_NEAR((energy(GetParam(), d + h) - energy(GetParam(), d - h)) / (2 * h), force(GetParam(), d),
                1e-8 * std::abs(force(GetParam(), d)));
    EXPECT_NEAR((force(GetParam(), d + h) - force(GetParam(), d - h)) / (2 * h), tangent(GetParam(), d),
                1e-8 * tangent(GetParam(), d));
  }
  EXPECT_EQ(force(GetParam(), 0), 0);
  EXPECT_EQ(energy(GetParam(), 0), 0);
}

TEST_P(EverySpring, StartingTangentIsTheOneAtThatForce) {
  const double d = 3e-4, f = force(GetParam(), d);
  EXPECT_NEAR(tangent_at_force(GetParam(), f), tangent(GetParam(), d), 1e-12 * tangent(GetParam(), d));
}

TEST_P(EverySpring, YieldingIsElongationAndTangentBesideAnyPreload) {
  if (jumps(GetParam())) GTEST_SKIP() << "at a jump the force is known, not the elongation";
  for (const double P : {0.0, 7.0, -3.0}) {
    const SpringLaw law = preloaded(GetParam(), P);
    for (const double f : {-40.0, 1.0, 90.0}) {
      const Yielding y = yielding(law, f);
      EXPECT_EQ(y.elongation, elongation(law, f));
      EXPECT_NEAR(y.stiffness, tangent(law, y.elongation), 1e-12 * y.stiffness);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Family, EverySpring,
                         ::testing::Values(SpringLaw{LinearSpring{3e5}}, SpringLaw{PowerSpring{1e9, 1.5}},
                                           SpringLaw{PowerSpring{1e8, 1.1}},
                                           SpringLaw{BulkLineSpring{1.4e-12, 0.03, 0.04, 2.0}},
                                           SpringLaw{PowerSpring{20, 5, 1e-4}}, SpringLaw{HardeningSpring{5e5, 1e-3}},
                                           SpringLaw{GapSpring{5e-5, 1e9}}, SpringLaw{OneSidedSpring{1e-6, 0, 1e9}},
                                           SpringLaw{FrictionSpring{1e5, 50}}));

TEST(HardeningSpring, ElongationIsTheInverseOfTheForce) {
  const HardeningSpring spring{5e5, 1e-4};
  for (const double f : {-1e9, -3.0, 1e-12, 1.0, 50.0, 1e4})
    EXPECT_NEAR(spring.force(spring.elongation(f)) / f, 1, 1e-14) << f;
}

// The force that a gap knows is kept where it closes: then its contact stiffness deflects nothing.
TEST(GapSpring, ClosesAtItsGapUnderTheForceItKnows) {
  SpringLaw law = GapSpring{5e-5, 1e6};
  know_force(law, 40);
  EXPECT_DOUBLE_EQ(force(law, 5e-5), 40);
  know_force(law, -40);
  EXPECT_DOUBLE_EQ(force(law, -5e-5), -40);
  EXPECT_EQ(stored_energy(law, -5e-5), 0);
}

/// Two nodes at one point, the first fixed; a connection between them.
Model two_bodies(const std::array<ConnectionFreedom, 6>& freedoms, const Matrix3& R = Matrix3::Identity()) {
  Model m;
  m.add_node("a", Vector3::Zero());
  m.add_node("b", Vector3::Zero());
  m.fix(0, "a");
  m.connect(0, 1, Vector3::Zero(), R, freedoms, "joint", "joint");
  return m;
}

// Two springs by hand: 1/k = 1/k₁ + 1/k₂ = 1/200 + 1/300, so 1 N moves 1/120 m; Hertz δ = (F/k)^{2/3}.
TEST(Connection, LawsInSeriesAddTheirDeflections) {
  std::array<ConnectionFreedom, 6> f;
  f[2] = {false, {LinearSpring{200}, LinearSpring{300}}};
  Model m = two_bodies(f);
  VectorX load = VectorX::Zero(m.dofs());
  load(8) = 1;
  EXPECT_NEAR(Solver(m).solve(load).u(8), 1.0 / 120, 1e-16);

  f[2].laws.push_back(PowerSpring{1e6, 1.5});
  m = two_bodies(f);
  for (const double force : {1.0, -8.0, 1e-3}) {
    load = VectorX::Zero(m.dofs());
    load(8) = force;
    const Solution s = Solver(m).solve(load);
    const double expected = force / 120 + std::copysign(std::pow(std::abs(force) / 1e6, 2.0 / 3), force);
    EXPECT_TRUE(s.converged);
    EXPECT_NEAR(s.u(8), expected, 1e-13 * std::abs(expected));
  }
}

TEST(Connection, UnloadedContactStaysAtRest) {
  std::array<ConnectionFreedom, 6> f;
  f[0] = {false, {PowerSpring{1e9, 1.5}}};
  f[1] = {false, {PowerSpring{1e9, 1.5}}};
  const Model m = two_bodies(f);
  VectorX load = VectorX::Zero(m.dofs());
  load(6) = 10;  // nothing along y
  const Solution s = Solver(m).solve(load);
  EXPECT_TRUE(s.converged);
  EXPECT_NEAR(s.u(6), std::pow(1e-8, 2.0 / 3), 1e-17);
  EXPECT_EQ(s.u(7), 0);
}

TEST(Connection, AxesTurnWithTheJoint) {
  std::array<ConnectionFreedom, 6> f;
  f[0] = {false, {LinearSpring{100}}};
  const Matrix3 R = rotation_from_rpy(0.3, -0.7, 1.1);
  const Model m = two_bodies(f, R);
  VectorX load = VectorX::Zero(m.dofs());
  load.segment<3>(6) = R.col(0) * 5 + R.col(1) * 7;
  EXPECT_LE((Solver(m).solve(load).u.segment<3>(6) - R.col(0) * 0.05).norm(), 1e-16);
}

TEST(Connection, LeverArmsOfBodiesAreExact) {
  Model m;
  m.add_node("ground", Vector3::Zero());
  m.add_node("body", {0.2, -0.1, 0.3});
  m.fix(0, "ground");
  std::array<ConnectionFreedom, 6> f;
  f[5] = {false, {LinearSpring{40}}};  // turns about z through the origin
  m.connect(0, 1, Vector3::Zero(), Matrix3::Identity(), f, "hinge", "hinge");
  VectorX load = VectorX::Zero(m.dofs());
  load(6) = 3;  // fx at y = −0.1: moment 0.3 about z
  const VectorX u = Solver(m).solve(load).u;
  EXPECT_NEAR(u(11), 0.3 / 40, 1e-16);
  EXPECT_NEAR(u(6), 0.1 * 0.3 / 40, 1e-17);
  EXPECT_NEAR(u(7), 0.2 * 0.3 / 40, 1e-17);
}

TEST(Elimination, NamesARedundantConstraintAndWhatImpliesIt) {
  Model m;
  for (const char* name : {"a", "b", "c"}) m.add_node(name, {static_cast<double>(m.nodes.size()), 0.5, 0});
  m.fix(0, "ground");
  m.join(0, 1, "arm 1");
  m.join(1, 2, "arm 2");
  m.join(0, 2, "arm 3");  // closes the loop: all six are implied
  const Elimination e = eliminate(m);
  EXPECT_EQ(e.independent, 0);
  ASSERT_EQ(e.redundant.size(), 6u);
  EXPECT_EQ(m.constraints[static_cast<std::size_t>(e.redundant[0].constraint)].name, "arm 3 tx");
  EXPECT_FALSE(e.redundant[0].implied_by.empty());
}

TEST(Elimination, RefusesAContradictionByName) {
  Model m;
  m.add_node("a", Vector3::Zero());
  m.add_node("b", {1, 0, 0});
  m.add_beam(0, 1, Matrix3::Identity(), {1, 1, 1, 1, none, none}, "", "");
  m.fix(0, "wall");
  m.constraints.push_back({{{0, 2}}, 0.5, "jack"});
  try {
    Solver solver(m);
    FAIL();
  } catch (const ModelError& e) {
    EXPECT_NE(std::string(e.what()).find("'jack' contradicts 'wall ux'"), std::string::npos) << e.what();
  }
}

// What is said twice with the same values stands, once as well as by its multiple; with other ones it is refused by
// what the others imply.
TEST(Elimination, AcceptsWhatIsImpliedWithItsValue) {
  const auto jacked = [](double apart) {
    Model m;
    m.add_node("a", Vector3::Zero());
    m.add_node("b", {1, 0, 0});
    m.add_beam(0, 1, Matrix3::Identity(), {1, 1, 1, 1, none, none}, "", "");
    for (int i = 1; i < 6; ++i) m.constraints.push_back({{{i, 1}}, 0, "guide"});
    m.constraints.push_back({{{0, 1}}, 2e-3, "a"});
    m.constraints.push_back({{{6, 2}}, 10e-3, "b"});
    m.constraints.push_back({{{6, 1}, {0, -1}}, apart, "apart"});
    return m;
  };
  const Model m = jacked(3e-3);
  const Solution s = Solver(m).solve(VectorX::Zero(m.dofs()));
  EXPECT_NEAR(s.u(0), 2e-3, 1e-17);
  EXPECT_NEAR(s.u(6), 5e-3, 1e-17);
  try {
    Solver solver(jacked(4e-3));
    ADD_FAILURE();
  } catch (const ModelError& e) {
    EXPECT_NE(std::string(e.what()).find("they imply the value 0.003, it asks for 0.004"), std::string::npos)
        << e.what();
  }
}

TEST(Elimination, ReducedFormKeepsEveryConstraint) {
  std::mt19937 random(7);
  Model m;
  for (int i = 0; i < 6; ++i) m.add_node("n", test::random_vector(random, 0.3));
  for (int i = 0; i < 5; ++i) {
    std::array<ConnectionFreedom, 6> f;
    f[static_cast<std::size_t>(i)].rigid = false;
    m.connect(i, i + 1, test::random_vector(random, 0.3), rotation_from_vector(test::random_vector(random, 3)), f, "j",
              "j");
  }
  for (Constraint& c : m.constraints) c.value = test::uniform(random, -1, 1);
  const Elimination e = eliminate(m);
  EXPECT_EQ(e.independent, 36 - 25);
  VectorX q(e.independent);
  for (Eigen::Index i = 0; i < q.size(); ++i) q(i) = test::uniform(random, -1, 1);
  const VectorX u = e.expand(q, constraint_values(m));
  for (const Constraint& c : m.constraints) EXPECT_NEAR(evaluate(c.form, u), c.value, 1e-13);
}

// More beams than are reduced at a time, side by side: each adds its EA/L.
TEST(Solver, ManyBeamsAddTheirStiffness) {
  Model m;
  m.add_node("a", Vector3::Zero());
  m.add_node("b", {0.2, 0, 0});
  constexpr int beams = 2500;
  for (int i = 0; i < beams; ++i) m.add_beam(0, 1, Matrix3::Identity(), {1e6 + i, 1, 1, 1, none, none}, "", "");
  m.fix(0, "wall");
  VectorX load = VectorX::Zero(m.dofs());
  load(6) = 1e6;
  const double EA = beams * (1e6 + (beams - 1) / 2.0);
  EXPECT_NEAR(Solver(m).solve(load).u(6), 1e6 * 0.2 / EA, 1e-12 * 1e6 * 0.2 / EA);
}

TEST(Solver, PrescribedDisplacementsAndReactions) {
  Model m;  // a rod pulled by 1 mm: EA/L = 5e6 N/m
  m.add_node("a", Vector3::Zero());
  m.add_node("b", {0.2, 0, 0});
  m.add_beam(0, 1, Matrix3::Identity(), {1e6, 1, 1, 1, none, none}, "", "");
  m.fix(0, "wall");
  m.constraints.push_back({{{6, 1}}, 1e-3, "pull"});
  const VectorX no_load = VectorX::Zero(m.dofs());
  const Solution s = Solver(m).solve(no_load);
  EXPECT_NEAR(s.u(6), 1e-3, 1e-18);
  const VectorX f = constraint_forces(m, eliminate(m), s.fine, no_load);
  EXPECT_NEAR(f(6), 5000, 1e-9);
  EXPECT_NEAR(f(0), -5000, 1e-9);
}

}  // namespace
}  // namespace deflect::frame
