// The two ways to solve the equations of a linear frame: they agree to the bound that is stated, the iterative one says
// the same for any number of threads, and leaves to the direct one what it cannot vouch for.
#include "msa/frame/iterative/linear_solution.h"

#include <gtest/gtest.h>

#include <cmath>

#include "msa/base/error.h"
#include "msa/frame/file/frame_analysis.h"
#include "tests/support/lattice.h"

namespace deflect::frame {
namespace {

FrameResult solved(const FrameDescription& f, Equations solver, int threads = 0) {
  FrameOptions options;
  options.equations.solver = solver;
  options.equations.threads = threads;
  return analyse(f, options);
}

double energy_norm(const Model& m, const VectorX& u) {
  VectorX ignored;
  return std::sqrt(u.dot(internal_forces(m, u, ignored)));
}

/// ‖a − b‖ / ‖b‖ in the energy norm of the whole structure.
double difference(const FrameResult& a, const FrameResult& b, std::size_t c = 0) {
  const Model& m = b.structure.model;
  return energy_norm(m, a.cases[c].u - b.cases[c].u) / energy_norm(m, b.cases[c].u);
}

TEST(LinearSolution, BothWaysAgreeToTheStatedBound) {
  FrameDescription f = test::lattice(6);
  f.members[7].second.bending_factor = 50;
  f.members[100].second.bending_factor = 0.02;
  const FrameResult direct = solved(f, Equations::direct), iterative = solved(f, Equations::iterative);
  ASSERT_EQ(iterative.equations.solver, "iterative") << iterative.equations.why;
  EXPECT_EQ(direct.equations.solver, "direct");
  EXPECT_FALSE(direct.equations.error_bound.has_value());
  ASSERT_TRUE(iterative.equations.error_bound.has_value());
  EXPECT_GT(iterative.equations.iterations, 0);
  EXPECT_LE(*iterative.equations.error_bound, 1e-10);
  // Factorisation and refinement leave √κ · 1e-16, κ < 1e7.
  EXPECT_LE(difference(iterative, direct), *iterative.equations.error_bound + 1e-12);
  EXPECT_EQ(failed_check(iterative), "");
}

TEST(LinearSolution, BothWaysAgreeUnderEveryKindOfLoadAndConnection) {
  FrameDescription f = test::lattice(4);
  const std::string top = test::lattice_node(1, 2, 3), side = test::lattice_node(3, 1, 2);
  f.materials[0].second.density = 7850;
  f.materials[0].second.expansion = 12e-6;
  FrameSpring stay{top, "", {}}, tie{top, side, {}};
  stay.stiffness[0] = 2e4, stay.stiffness[4] = 5;
  tie.stiffness[1] = 1e4;
  f.springs = {{"stay", stay}, {"tie", tie}};
  f.rigid_links.push_back({"plate", {test::lattice_node(0, 0, 3), {test::lattice_node(1, 1, 3)}}});
  f.constraints.push_back({"same", {{{top, 0, 1, {}}, {side, 4, -1, 0.3}}}});
  f.loads[0].second.gravity = {0, 0, -9.81};
  f.loads.push_back({"heat and settlement", {}});
  f.loads[1].second.temperature.push_back({f.members[50].first, 40.0});
  f.loads[1].second.members.push_back({f.members[60].first, {{0, 3, 1}, true}});
  FreedomValues settles;
  settles[2] = -1e-3;
  f.loads[1].second.displacements.push_back({f.supports[0].first, settles});
  const FrameResult direct = solved(f, Equations::direct), iterative = solved(f, Equations::iterative);
  ASSERT_EQ(iterative.equations.solver, "iterative") << iterative.equations.why;
  for (std::size_t c = 0; c < 2; ++c) EXPECT_LE(difference(iterative, direct, c), 1e-10);
  EXPECT_EQ(failed_check(iterative), "");
  EXPECT_EQ(iterative.notes, direct.notes);
}

TEST(LinearSolution, AChainIsAnsweredAtOnce) {  // the incomplete factor of a chain is complete
  FrameDescription f = test::lattice(2);
  f.nodes.clear(), f.members.clear(), f.supports.clear(), f.loads[0].second.nodes.clear();
  for (int i = 0; i <= 5; ++i) {
    f.nodes.push_back({std::to_string(i), {0.1 * i, 0, 0}});
    if (i == 0) continue;
    FrameMember m;
    m.from = std::to_string(i - 1), m.to = std::to_string(i), m.section = "rod", m.material = "steel";
    f.members.push_back({"m" + std::to_string(i), m});
  }
  f.supports.push_back({"0", Freedoms{true, true, true, true, true, true}});
  f.loads[0].second.nodes.push_back({"5", Vector6::Unit(2)});
  const FrameResult r = solved(f, Equations::iterative);
  ASSERT_EQ(r.equations.solver, "iterative") << r.equations.why;
  EXPECT_LE(r.equations.iterations, 3);  // one, and what rounding asks for
  const double EI = 210e9 * pi * std::pow(0.006, 4) / 64;
  EXPECT_NEAR(r.cases[0].displacements[5](2), std::pow(0.5, 3) / 3 / EI, 1e-9);
}

TEST(LinearSolution, ResultsAreTheSameBitsForAnyNumberOfThreads) {
  const FrameDescription f = test::lattice(9);
  const FrameResult one = solved(f, Equations::iterative, 1), two = solved(f, Equations::iterative, 2);
  ASSERT_EQ(one.equations.solver, "iterative") << one.equations.why;
  EXPECT_EQ(one.cases[0].u, two.cases[0].u);
  EXPECT_EQ(one.equations.iterations, two.equations.iterations);
}

TEST(LinearSolution, AssemblyIsTheSameBitsForAnyNumberOfThreads) {
  const FrameModel m = build_frame(test::lattice(10));
  const Elimination e = eliminate(m.model);
  const Assembly one(m.model, e, 1), two(m.model, e, 2);
  EXPECT_EQ(one.pattern().row, two.pattern().row);
  EXPECT_EQ(one.values(VectorX()), two.values(VectorX()));
}

TEST(LinearSolution, SmallFramesAndManyLoadCasesAreFactorised) {
  const FrameResult r = solved(test::lattice(3), Equations::automatic);
  EXPECT_EQ(r.equations.solver, "direct");
  EXPECT_EQ(r.equations.why, "162 freedoms, fewer than 20000");
}

TEST(LinearSolution, StiffPartsBesideSlenderOnesFallBack) {
  FrameDescription f = test::lattice(4);
  f.sections.push_back({"column", {RoundSection{0.3}}});
  f.members[40].second.section = "column";
  const FrameResult direct = solved(f, Equations::direct), r = solved(f, Equations::iterative);
  EXPECT_EQ(r.equations.solver, "direct");
  EXPECT_EQ(r.equations.why, "not iteratively: parts whose stiffnesses differ by more than 1e5");
  EXPECT_FALSE(r.equations.error_bound.has_value());
  EXPECT_EQ(r.cases[0].u, direct.cases[0].u);
}

TEST(LinearSolution, AnIllConditionedChainFallsBack) {
  FrameDescription f = test::lattice(2);
  f.nodes.clear(), f.members.clear(), f.supports.clear(), f.loads[0].second.nodes.clear();
  FrameMember m;
  m.from = "0", m.to = "1", m.section = "rod", m.material = "steel", m.elements = 3000;
  f.nodes = {{"0", Vector3::Zero()}, {"1", {300, 0, 0}}};
  f.members = {{"chain", m}};
  f.supports.push_back({"0", Freedoms{true, true, true, true, true, true}});
  f.loads[0].second.nodes.push_back({"1", Vector6::Unit(2)});
  const FrameResult r = solved(f, Equations::iterative);
  EXPECT_EQ(r.equations.solver, "direct");
  EXPECT_NE(r.equations.why.find("ill-conditioned"), std::string::npos) << r.equations.why;
}

std::string refusal(const FrameDescription& f, Equations solver) {
  try {
    solved(f, solver);
  } catch (const ModelError& e) {
    return e.what();
  }
  return "";
}

TEST(LinearSolution, MechanismsAreNamedAsByTheDirectWay) {
  FrameDescription sliding = test::lattice(3);
  for (auto& [node, freedoms] : sliding.supports) freedoms = Freedoms{false, true, true, false, false, false};
  FrameDescription loose = test::lattice(3);  // an end node that all its members let go
  const std::string tip = test::lattice_node(2, 2, 2);
  for (auto& [name, member] : loose.members) {
    if (member.to == tip) member.release_to.fill(true);
    if (member.from == tip) member.release_from.fill(true);
  }
  for (const FrameDescription* f : {&sliding, &loose}) {
    const std::string direct = refusal(*f, Equations::direct);
    EXPECT_NE(direct.find("that nothing resists"), std::string::npos) << direct;
    EXPECT_EQ(refusal(*f, Equations::iterative), direct);
    EXPECT_EQ(refusal(*f, Equations::automatic), direct);
  }
}

}  // namespace
}  // namespace deflect::frame
