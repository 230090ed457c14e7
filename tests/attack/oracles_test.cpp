// The oracles themselves, on structures that are solved by hand.
#include <gtest/gtest.h>

#include "msa/frame/file/frame_file.h"
#include "tests/attack/dense_oracle.h"
#include "tests/attack/device_oracle.h"
#include "tests/attack/echelon.h"
#include "tests/attack/shape_oracle.h"
#include "tests/attack/standing_oracle.h"
#include "tests/support/elastica.h"
#include "tests/support/mechanisms.h"
#include "tests/support/paths.h"

namespace deflect::attack {
namespace {

/// Nodes on whole metres; E = 100, G = 40; A = 0.5, Iy = 0.25, Iz = 0.125, J = 0.0625, shear areas 0.25.
frame::FrameDescription frame_of(const std::string& rest) {
  return frame::parse_frame(
      "name: test\nmaterials: {m: {E: 100 Pa, G: 40 Pa}}\n"
      "sections: {s: {shape: given, A: 0.5 m^2, Iy: 0.25 m^4, Iz: 0.125 m^4, J: 0.0625 m^4, As_y: 0.25 m^2, As_z: 0.25 "
      "m^2}}\n" +
          rest,
      "test");
}

TEST(DenseOracle, SolvesACantileverWithShear) {
  const DenseSolution s = solve_dense(
      frame_of("nodes: {a: [0 m, 0 m, 0 m], b: [2 m, 0 m, 0 m]}\n"
               "members: {m: {from: a, to: b, section: s, material: m, beam: timoshenko}}\nsupports: {a: clamped}\n"
               "loads: {up: {nodes: {b: {fz: 1 N}}}, turn: {nodes: {b: {mx: 1 Nm}}}}\n"),
      {});
  // local y is up: bending about local z, EIz = 12.5; GA = 10.
  EXPECT_DOUBLE_EQ(s.cases[0].displacements[1](2), 8 / (3 * 12.5) + 2 / 10.0);
  EXPECT_DOUBLE_EQ(s.cases[0].displacements[1](4), -4 / (2 * 12.5));
  EXPECT_DOUBLE_EQ(s.cases[1].displacements[1](3), 2 / 2.5);
  EXPECT_DOUBLE_EQ(s.cases[0].ends[0](1), 1);
}

// A bar hinged at its far end to a spring: the beam's tip and the spring share the load by their stiffnesses.
TEST(DenseOracle, SolvesABeamOnASpringBehindALink) {
  const DenseSolution s = solve_dense(
      frame_of("nodes: {a: [0 m, 0 m, 0 m], b: [2 m, 0 m, 0 m], c: [3 m, 0 m, 0 m]}\n"
               "members: {m: {from: a, to: b, section: s, material: m}}\nsupports: {a: clamped}\n"
               "rigid_links: {l: {master: b, nodes: [c], freedoms: [uz]}}\n"
               "springs: {k: {node: c, ux: 1 N/m, uy: 1 N/m, uz: 3 N/m, rx: 1 Nm/rad, ry: 1 Nm/rad, rz: 1 Nm/rad}}\n"
               "loads: {up: {nodes: {c: {fz: 1 N}}}}\n"),
      {});
  // The force F on b acts at the lever of 1 m: u_c = u_b − θ_b = F (8/3 + 2 + 2 + 2)/12.5 for θ_b = −F (2 + 2)/12.5.
  const double k = 12.5 / (8.0 / 3 + 2 + 2 + 2);
  EXPECT_NEAR(s.cases[0].displacements[2](2), 1 / (k + 3), 1e-15);
}

TEST(StandingOracle, KnowsWhatMovesWhatIsIdleAndWhatIsDriven) {
  const std::string nodes = "nodes: {a: [0 m, 0 m, 0 m], b: [2 m, 0 m, 0 m], c: [4 m, 0 m, 0 m], d: [2 m, 0 m, 3 m]}\n";
  const std::string hinges = "release_from: [rx, ry, rz], release_to: [rx, ry, rz]";
  const auto truss = [&](const std::string& load) {
    return can_stand(frame_of(nodes + "members: {p: {from: a, to: d, section: s, material: m, " + hinges +
                              "}, q: {from: c, to: d, section: s, material: m, " + hinges +
                              "}}\nsupports: {a: clamped, b: clamped, c: clamped, d: [uy]}\nloads: {l: {nodes: {d: {" +
                              load + "}}}}\n"));
  };
  const StandingVerdict idle = truss("fz: 1 N");  // both bars spin, d turns about three axes
  EXPECT_EQ(idle.standing, Standing::idle);
  EXPECT_EQ(idle.motions, 5);
  EXPECT_EQ(idle.to_hold, (std::vector<int>{21, 22, 23}));
  EXPECT_EQ(idle.turns, (std::vector<bool>{false, false, false, true}));
  EXPECT_EQ(truss("my: 1 Nm").standing, Standing::driven);

  const auto line = [&](const std::string& release) {
    return can_stand(frame_of(nodes + "members: {p: {from: a, to: b, section: s, material: m, release_to: " + release +
                              "}, q: {from: b, to: c, section: s, material: m}}\nsupports: {a: clamped, c: [uy, uz], "
                              "d: clamped}\nloads: {l: {nodes: {b: {fz: 1 N}}}}\n"));
  };
  EXPECT_EQ(line("[ry, rz]").standing, Standing::stands);
  EXPECT_EQ(line("[tx]").standing, Standing::moves);
  EXPECT_EQ(line("[rx]").standing, Standing::idle);  // q spins, and b and c with it
}

TEST(StandingOracle, SeesTheFramesThatWereOnceAnswered) {
  for (const char* name : {"swinging-member", "turning-frame"}) {
    const StandingVerdict v =
        can_stand(frame::read_frame(test::source_dir() + "/tests/attack/cases/" + name + ".yaml"));
    EXPECT_EQ(v.standing, Standing::moves) << name;
    EXPECT_EQ(v.motions, 1) << name;
  }
}

using test::joint;
using test::spring;

// Two springs of 3 and 6 N/m in one leg, of 2 N/m in the other, along x; all else rigid: 1/(2 + 2) m/N.
TEST(ForceMethod, AddsSpringsInSeriesAndInParallel) {
  const Vector3 o = Vector3::Zero();
  const Configuration c = test::configuration(
      o, {{"a", {spring("p", o, {{0, 3}}), spring("q", o, {{0, 6}})}}, {"b", {spring("r", o, {{0, 2}})}}}, 1);
  const DeviceTruth t = solve_by_forces(c);
  EXPECT_TRUE(t.held && t.clear);
  EXPECT_EQ(t.rigid_directions, 5);
  EXPECT_DOUBLE_EQ(t.flexibility(0, 0), 0.25);
}

TEST(ForceMethod, KnowsWhatMovesWhatIsRigidAndWhatIsIdle) {
  const Vector3 o = Vector3::Zero();
  const auto of = [&](std::vector<PlacedPart> parts) {
    return solve_by_forces(test::configuration(o, {{"a", std::move(parts)}}, 1));
  };
  EXPECT_FALSE(of({joint("slide", o, "rrfrrr")}).held);
  EXPECT_EQ(of({joint("fixed", o, "rrrrrr")}).rigid_directions, 6);
  const DeviceTruth beside = solve_by_forces(test::configuration(
      o, {{"a", {joint("p", o, "rrfrrr"), joint("q", o, "rrfrrr")}}, {"b", {spring("r", o, {{2, 4}})}}}, 1));
  EXPECT_TRUE(beside.held);  // by b; between the two slides of a stands a body that slides idly
  EXPECT_EQ(beside.idle, 1);
  EXPECT_DOUBLE_EQ(beside.flexibility(2, 2), 0.25);
}

// A rod between balls spins about itself: idle. A clamped rod is a cantilever.
TEST(ForceMethod, KnowsRods) {
  const Vector3 foot(0, 0, 0), head(0, 0, 0.5);
  const PlacedMember rod = test::rod("rod", foot, head, 0.01);
  const DeviceTruth clamped = solve_by_forces(test::configuration(head, {{"a", {rod}}}, 0.5));
  EXPECT_EQ(clamped.rigid_directions, 0);
  const double EI = rod.E * rod.section.Iy;
  EXPECT_NEAR(clamped.flexibility(0, 0), 0.125 / (3 * EI), 1e-15 / EI);
  EXPECT_NEAR(clamped.stiffness(2, 2), rod.E * rod.section.A / 0.5, 1e-6);
  const DeviceTruth strut = solve_by_forces(test::configuration(
      head, {{"a", {joint("p", foot, "rrrfff"), rod, joint("q", head, "rrrfff")}}, {"b", {rod}}}, 0.5));
  EXPECT_EQ(strut.idle, 1);
  EXPECT_NEAR(strut.stiffness(2, 2), 2 * rod.E * rod.section.A / 0.5, 1e-6);
}

TEST(Echelon, FindsRankNullSpaceAndWhatCannotBeReached) {
  RealMatrix A(2, 4);  // rows (1 2 3), (2 4 6); B = (1, 1)
  for (std::size_t j = 0; j < 3; ++j) A(0, j) = j + 1, A(1, j) = 2 * (j + 1);
  A(0, 3) = A(1, 3) = 1;
  const Echelon e(std::move(A), 3, Real("1e-10"));
  EXPECT_EQ(e.rank(), 1u);
  EXPECT_EQ(e.null_space().size(), 2u);
  EXPECT_EQ(static_cast<double>(e.left_over()), 0.5);
}

// k θ = L (Q cos θ + N sin θ) under a push N along an arm of length L and Q across it; beyond k/L it falls.
TEST(ShapeOracle, FindsTheAngleOfAPendulumAndThatItFalls) {
  const double k = 300, L = 0.5, N = 250, Q = 90;
  const Configuration c = test::configuration({L, 0, 0}, {{"arm", {spring("hinge", Vector3::Zero(), {{5, k}})}}}, L);
  Vector6 F = Vector6::Zero();
  F.head<2>() << -N, Q;
  const ShapeTruth t = solve_in_shape(c, F, 0.3);
  ASSERT_TRUE(t.found && t.stable && t.regular);
  const double angle = t.displacement(5), stiffness = k - L * (N * std::cos(angle) - Q * std::sin(angle));
  EXPECT_NEAR(k * angle, L * (Q * std::cos(angle) + N * std::sin(angle)), 1e-12 * k);
  EXPECT_NEAR(t.displacement(0), L * (std::cos(angle) - 1), 1e-14);
  EXPECT_NEAR(t.compliance(5, 5), 1 / stiffness, 1e-8 / stiffness);
  EXPECT_NEAR(t.at_rest(5, 5), 1 / k, 1e-8 / k);
  F.head<2>() << -1.2 * k / L, 0;
  EXPECT_FALSE(solve_in_shape(c, F, 0.3).stable);
}

TEST(ShapeOracle, BendsACantileverAsTheElastica) {
  PlacedMember m = test::rod("rod", Vector3::Zero(), {1, 0, 0}, 0.01);
  m.E = 1 / m.section.Iz;
  m.G = m.E / 2.6;
  m.section.A = 1e9 / m.E;
  const Configuration c = test::configuration({1, 0, 0}, {{"leg", {m}}}, 1);
  for (const double P : {0.1, 1.0, 2.0}) {
    const test::Elastica exact = test::elastica(P, pi / 2);
    const ShapeTruth t = solve_in_shape(c, P * Vector6::Unit(1), P / 3);
    ASSERT_TRUE(t.found && t.stable) << P;
    EXPECT_NEAR(1 + t.displacement(0), exact.x, 2e-8) << P;  // N/EA = 1e-9 P, and a fifteenth of 1e-7
    EXPECT_NEAR(t.displacement(1), exact.y, 2e-8) << P;
    EXPECT_NEAR(t.displacement(5), exact.angle, 2e-8) << P;
  }
}

}  // namespace
}  // namespace deflect::attack
