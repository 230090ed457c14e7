// Legs and branches side by side.
#include <gtest/gtest.h>

#include "analytic/constraint.h"
#include "analytic/member.h"
#include "analytic/model.h"
#include "tests/support/mechanisms.h"

namespace deflect::analytic {
namespace {

using test::joint;
using test::rod;
using test::spring;

// K = Σ k s sᵀ = J⁻ᵀ diag(k) J⁻¹ with the line s of each strut (C. Gosselin, IEEE Trans. Robot. Autom. 6 (1990) 377).
TEST(Hexapod, StiffnessIsThatOfItsStruts) {
  std::mt19937 random(7);
  for (int pose = 0; pose < 10; ++pose) {
    const Vector3 p_WT = Vector3(0, 0, 0.42) + test::random_vector(random, 0.05);
    std::vector<PlacedLeg> legs;
    Matrix6 K = Matrix6::Zero();
    for (const auto& [foot, head] : test::hexapod(random)) {
      const double k = test::uniform(random, 1e6, 1e8);
      legs.push_back(test::strut("leg " + std::to_string(legs.size() + 1), foot, head, k));
      const Vector3 n = (head - foot).normalized();
      Vector6 s;
      s << n, (head - p_WT).cross(n);
      K += k * s * s.transpose();
    }
    const Configuration c = test::configuration(p_WT, legs, 0.5);
    const AnalyticModel model(c);
    const AnalyticSolution s = model.solve(test::random_wrench(random));
    EXPECT_LE((model.stiffness(s) - K).norm(), 1e-12 * K.norm());
    EXPECT_LE((model.compliance(s) * K - Matrix6::Identity()).norm(), 1e-10);
    EXPECT_EQ(redundant_constraints(c), 0);
  }
}

// Two rods with balls at both ends between two plates, a distance b apart along y, length L along x: the far plate is
// held along x and about z by the rods, 2 EA/L and 2 (b/2)² EA/L, and free in all else.
TEST(Parallelogram, HoldsWhatItsRodsHold) {
  const double L = 0.4, b = 0.1;
  const PlacedMember bar = rod("bar", Vector3(0, b / 2, 0), Vector3(L, b / 2, 0), 0.006);
  const double k = bar.E * bar.section.A / L;
  PlacedParallel loop{"loop", Vector3::Zero(), Vector3(L, 0, 0), {}};
  for (const double y : {-b / 2, b / 2})
    loop.branches.push_back(
        {"bar",
         {joint("ball", Vector3(0, y, 0), "rrrfff"), rod("bar", Vector3(0, y, 0), Vector3(L, y, 0), 0.006),
          joint("ball", Vector3(L, y, 0), "rrrfff")}});
  const PlacedLeg leg{"leg", {loop}};
  const Chain chain = chain_of(leg, Vector3(L, 0, 0), 0.5);
  EXPECT_EQ(chain.J_q.cols(), 4);
  ASSERT_EQ(chain.N.cols(), 2);
  Matrix6 K = Matrix6::Zero();
  K(0, 0) = 2 * k;
  K(5, 5) = 2 * k * b * b / 4;
  const Vector6 F = (Vector6() << 100, 0, 0, 0, 0, 3).finished();
  EXPECT_LE((chain.stiffness(F, {}) - K).norm(), 1e-12 * K.norm());
  EXPECT_NEAR(chain.deflection(F, {})(0) / (100 / K(0, 0)), 1, 1e-12);
  EXPECT_NEAR(chain.deflection(F, {})(5) / (3 / K(5, 5)), 1, 1e-12);
  Configuration c = test::configuration(Vector3(L, 0, 0), {leg}, 0.5);
  EXPECT_THROW(AnalyticModel(c).solve(F), ModelError);
  // Springs across make it stand.
  c.legs.push_back({"guide",
                    {spring("guide", Vector3(L, 0, 0), {{1, 3e4}, {2, 2e4}, {3, 50}, {4, 60}}),
                     joint("slot", Vector3(L, 0, 0), "frrrrf")}});
  const AnalyticModel model(c);
  K.diagonal() << 2 * k, 3e4, 2e4, 50, 60, 2 * k * b * b / 4;
  EXPECT_LE((model.stiffness(model.solve(F)) - K).norm(), 1e-12 * K.norm());
}

TEST(Hybrid, CompliancesOfStagesAdd) {
  std::mt19937 random(2);
  const Vector3 p_WT(0.1, 0, 0.9);
  PlacedParallel stage{"hexapod", Vector3::Zero(), Vector3(0, 0, 0.4), {}};
  for (const auto& [foot, head] : test::hexapod(random))
    stage.branches.push_back(test::strut("strut", foot, head, 1e7));
  const PlacedMember column = rod("column", Vector3(0, 0, 0.4), Vector3(0.1, 0, 0.9), 0.03);
  const PlacedJoint wrist = spring("wrist", Vector3(0.1, 0, 0.9), {{3, 2e3}, {4, 3e3}, {5, 1e3}});
  const Vector6 F = test::random_wrench(random);
  const auto compliance = [&](std::vector<PlacedPart> parts) {
    const AnalyticModel model(test::configuration(p_WT, {{"arm", std::move(parts)}}, 1));
    return model.compliance(model.solve(F));
  };
  const Matrix6 whole = compliance({stage, column, wrist});
  const Matrix6 sum = compliance({stage}) + compliance({column}) + compliance({wrist});
  EXPECT_LE((whole - sum).norm(), 1e-12 * sum.norm());
  EXPECT_LE((compliance({column}) - moved_to(p_WT, column, column.R_WM, tip_compliance(column))).norm(),
            1e-14 * sum.norm());
  // The stage alone is the mechanism of its struts.
  const AnalyticModel hexapod(test::configuration(p_WT, stage.branches, 1));
  EXPECT_LE((compliance({stage}) - hexapod.compliance(hexapod.solve(F))).norm(), 1e-12 * sum.norm());
}

// A branch of branches, contacts included, is the same as its branches on their own.
TEST(Hybrid, NestedLegsAreLegs) {
  Configuration c = test::random_mechanism(3, true);
  c.base = joint("base", Vector3::Zero(), "rrrrrr");
  c.tool = joint("tool", c.pose.p_WT, "rrrrrr");
  c.legs[1].misfit << 1e-5, 0, 2e-5, 1e-4, 0, 0;
  Configuration nested = c;
  nested.legs = {{"all", {PlacedParallel{"inner", Vector3::Zero(), c.pose.p_WT, c.legs}}}};
  Configuration half = c;
  half.legs = {c.legs[0],
               {"rest", {PlacedParallel{"inner", Vector3::Zero(), c.pose.p_WT, {c.legs[1], c.legs[2], c.legs[3]}}}}};
  std::mt19937 random(8);
  const Vector6 F = test::random_wrench(random);
  const AnalyticModel model(c);
  const AnalyticSolution s = model.solve(F);
  ASSERT_TRUE(s.converged);
  for (const Configuration& other : {nested, half}) {
    const AnalyticModel same(other);
    const AnalyticSolution t = same.solve(F);
    ASSERT_TRUE(t.converged);
    EXPECT_LE((t.displacement - s.displacement).norm(), 1e-10 * s.displacement.norm());
    EXPECT_LE((same.stiffness(t) - model.stiffness(s)).norm(), 1e-8 * model.stiffness(s).norm());
    const auto energies = same.energies(t);
    for (std::size_t i = 0; i < energies.size(); ++i) {
      EXPECT_EQ(energies[i].first, model.energies(s)[i].first);
      EXPECT_NEAR(energies[i].second, model.energies(s)[i].second, 1e-9 * energies[0].second);
    }
    EXPECT_EQ(redundant_constraints(other), redundant_constraints(c));
  }
}

// A rigid strut among elastic ones: the limit of a stiff one.
TEST(RigidBranch, IsTheLimitOfAStiffOne) {
  std::mt19937 random(5);
  const auto struts = test::hexapod(random);
  const Vector3 p_WT(0, 0, 0.42);
  const auto mechanism = [&](double k_first) {
    std::vector<PlacedLeg> legs;
    for (const auto& [foot, head] : struts)
      legs.push_back(test::strut("leg", foot, head, legs.empty() ? k_first : 1e6));
    if (k_first == 0) std::get<PlacedJoint>(legs[0].parts[1]).laws[2].clear();
    return test::configuration(p_WT, legs, 0.5);
  };
  const Vector6 F = test::random_wrench(random);
  const AnalyticModel rigid(mechanism(0));
  const AnalyticSolution s = rigid.solve(F);
  ASSERT_TRUE(s.converged);
  for (const double k : {1e10, 1e14, 1e18, 1e22}) {  // up to 10¹⁶ times stiffer than its neighbours
    const AnalyticModel stiff(mechanism(k));
    const AnalyticSolution t = stiff.solve(F);
    ASSERT_TRUE(t.converged);
    EXPECT_LE((t.displacement - s.displacement).norm(), (20 * 1e6 / k + 1e-12) * s.displacement.norm()) << k;
    EXPECT_LE((stiff.compliance(t) - rigid.compliance(s)).norm(), (20 * 1e6 / k + 1e-12) * rigid.compliance(s).norm())
        << k;
  }
  try {
    rigid.stiffness(s);
    FAIL();
  } catch (const ModelError& e) {
    EXPECT_NE(std::string(e.what()).find("leg: infinite stiffness: held rigidly, nothing yields in translation along"),
              std::string::npos)
        << e.what();
  }
  // On an elastic base its stiffness is finite again.
  Configuration mounted = mechanism(0);
  mounted.base = spring("base", Vector3::Zero(), {{0, 1e7}, {1, 1e7}, {2, 1e7}, {3, 1e5}, {4, 1e5}, {5, 1e5}});
  const AnalyticModel model(mounted);
  const AnalyticSolution m = model.solve(F);
  EXPECT_LE((model.stiffness(m) * m.displacement - F).norm(), 1e-10 * F.norm());
}

// Two rigid rods side by side carry the same wrenches twice: the displacement is determined, of the forces the smallest
// are taken; if they do not fit, they cannot be assembled.
TEST(RigidBranch, SeveralShareWhatTheyLeaveOpen) {
  const auto leg = [](const std::string& name) {
    return PlacedLeg{name, {spring("motor", Vector3::Zero(), {}), joint("slide", Vector3::Zero(), "rfrrrr")}};
  };
  const PlacedLeg soft{"spring",
                       {spring("spring", Vector3::Zero(), {{1, 1e4}}), joint("all else", Vector3::Zero(), "frffff")}};
  Configuration c = test::configuration(Vector3::Zero(), {leg("a"), leg("b"), soft}, 0.3);
  EXPECT_EQ(redundant_constraints(c), 5);
  const Vector6 F = (Vector6() << 10, 5, 0, 0, 2, 0).finished();
  const AnalyticSolution s = AnalyticModel(c).solve(F);
  ASSERT_TRUE(s.converged);
  EXPECT_LE((s.displacement - 5e-4 * Vector6::Unit(1)).norm(), 1e-15);
  for (int i : {0, 1})
    EXPECT_LE((s.leg_wrenches[static_cast<std::size_t>(i)] - (Vector6() << 5, 0, 0, 0, 1, 0).finished()).norm(), 1e-13);
  c.legs[0].misfit = c.legs[1].misfit = 1e-4 * Vector6::Unit(0);
  EXPECT_NEAR(AnalyticModel(c).assembled().displacement(0), 1e-4, 1e-16);
  c.legs[1].misfit *= -1;
  EXPECT_THROW(AnalyticModel(c).solve(F), ModelError);
}

// Three legs that slide and turn thrice about parallel axes, directions x, y, z: locked, nine wrenches are carried
// where six are needed. Freed of two of three axes' parallelism (spherical wrists) none is left over.
TEST(Constraint, CountsWhatMustFit) {
  std::vector<PlacedLeg> legs;
  for (int i = 0; i < 3; ++i) {
    const Matrix3 R = test::z_along(Vector3::Unit(i));
    const Vector3 u = Vector3::Unit((i + 1) % 3), v = Vector3::Unit((i + 2) % 3);
    legs.push_back({"leg",
                    {joint("slider", Vector3::Zero(), "rrarrr", R), joint("a", 0.2 * v, "rrrrrf", R),
                     joint("b", 0.2 * (u + v), "rrrrrf", R), joint("c", 0.1 * u, "rrrrrf", R)}});
  }
  const Configuration c = test::configuration(Vector3::Zero(), legs, 0.3);
  EXPECT_EQ(redundant_constraints(c), 3);
  Configuration arm = c;
  arm.legs.resize(1);
  EXPECT_EQ(redundant_constraints(arm), 0);
  // A parallelogram of four hinges: planar, three times overdetermined.
  PlacedParallel loop{"loop", Vector3::Zero(), Vector3(0.3, 0, 0), {}};
  for (const double y : {-0.05, 0.05})
    loop.branches.push_back(
        {"bar", {joint("hinge", Vector3(0, y, 0), "rrrrrf"), joint("hinge", Vector3(0.3, y, 0), "rrrrrf")}});
  arm.legs = {{"arm", {joint("motor", Vector3::Zero(), "rrrrra"), loop}}};
  EXPECT_EQ(redundant_constraints(arm), 3);
  EXPECT_EQ(redundant_constraints(configure(test::device("haptic-6psu"), test::home(test::device("haptic-6psu")))), 0);
}

}  // namespace
}  // namespace deflect::analytic
