// Structures that cannot stand, harmless spins, and parts so stiff that they are nearly rigid.
#include "msa/frame/structure/stability.h"

#include <gtest/gtest.h>

#include <limits>

#include "msa/base/error.h"
#include "msa/frame/structure/solver.h"

namespace deflect::frame {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

TEST(Solver, RefusesAHingeInMidSpanWhateverTheLoad) {
  Model m;  // clamped, hinged in the middle, only held sideways at the far end: a mechanism
  m.add_node("left", Vector3::Zero());
  m.add_node("hinge, left side", {0.5, 0, 0});
  m.add_node("hinge, right side", {0.5, 0, 0});
  m.add_node("right", {1, 0, 0});
  const BeamRigidity r{1e6, 100, 100, 80, none, none};
  m.add_beam(0, 1, Matrix3::Identity(), r, "", "");
  m.add_beam(2, 3, Matrix3::Identity(), r, "right span", "");
  m.fix(0, "wall");
  std::array<ConnectionFreedom, 6> hinge;
  hinge[5].rigid = false;
  m.connect(1, 2, m.nodes[1].position, Matrix3::Identity(), hinge, "hinge", "");
  for (const int dof : {1, 0}) {  // a load that drives the free motion, and one that does not
    VectorX load = VectorX::Zero(m.dofs());
    load(18 + dof) = 1;
    try {
      Solver(m).solve(load);
      ADD_FAILURE() << "a mechanism was solved";
    } catch (const ModelError& e) {
      EXPECT_NE(std::string(e.what()).find("1 motion that nothing resists"), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("right span turns about (0, 0, 1) through (500, 0, 0) mm"),
                std::string::npos)
          << e.what();
      EXPECT_NE(std::string(e.what()).find("hinge rz"), std::string::npos) << e.what();
    }
  }
}

// Beside a member 1e12 times stiffer the others look like nothing; that is no mechanism.
TEST(Solver, AnExtremeRatioOfStiffnessesIsNotTakenForAMechanism) {
  Model m;
  m.add_node("a", Vector3::Zero());
  m.add_node("b", {0.1, 0, 0});
  m.add_node("c", {0.2, 0, 0});
  const BeamRigidity r{1e6, 40, 40, 30, none, none};
  m.add_beam(0, 1, Matrix3::Identity(), r, "", "");
  m.add_beam(1, 2, Matrix3::Identity(), {1e18, 4e13, 4e13, 3e13, none, none}, "", "");
  m.fix(0, "wall");
  VectorX load = VectorX::Zero(m.dofs());
  load(12) = 1;
  EXPECT_NO_THROW(Solver(m).solve(load));
}

TEST(Solver, RigidAndVeryStiffLinksGiveTheSameAnswer) {
  const auto tip_for = [](double stiffer) {
    Model m;
    m.add_node("a", Vector3::Zero());
    m.add_node("b", {0.1, 0, 0});
    m.add_node("c", {0.1, 0.1, 0});
    const BeamRigidity r{1e6, 40, 40, 30, none, none};
    m.add_beam(0, 1, Matrix3::Identity(), r, "", "");
    m.fix(0, "wall");
    if (stiffer > 0)
      m.add_beam(1, 2, axes_along_x({0, 1, 0}, {1, 0, 0}),
                 {stiffer * r.EA, stiffer * r.EIy, stiffer * r.EIz, stiffer * r.GJ, none, none}, "", "");
    else
      m.join(1, 2, "rigid");
    VectorX load = VectorX::Zero(m.dofs());
    load.tail<6>() << 1, 2, 3, 0.1, 0.2, 0.3;
    return VectorX(Solver(m).solve(load).u.segment<6>(12));
  };
  const VectorX rigid = tip_for(0);
  // The link itself yields: its compliance is that of the member over the ratio, seen through a lever of its own
  // length.
  for (const double stiffer : {1e4, 1e6, 1e9, 1e12, 1e15})
    EXPECT_LE((tip_for(stiffer) - rigid).norm(), (100 / stiffer + 1e-12) * rigid.norm()) << stiffer;
}

TEST(Solver, AVeryStiffSpringGivesTheSameAnswerAsARigidJoint) {
  const auto tip_for = [](double k) {
    Model m;
    for (const double x : {0.0, 0.1, 0.1, 0.2}) m.add_node("n", {x, 0, 0});
    const BeamRigidity r{1e6, 40, 40, 30, none, none};
    m.add_beam(0, 1, Matrix3::Identity(), r, "", "");
    m.add_beam(2, 3, Matrix3::Identity(), r, "", "");
    m.fix(0, "wall");
    std::array<ConnectionFreedom, 6> joint;
    if (k > 0) joint[1] = {false, {LinearSpring{k}}};
    m.connect(1, 2, m.nodes[1].position, Matrix3::Identity(), joint, "joint", "joint");
    VectorX load = VectorX::Zero(m.dofs());
    load.segment<3>(18) << 1, 2, 3;
    return VectorX(Solver(m).solve(load).u.segment<6>(18));
  };
  const VectorX rigid = tip_for(0);
  for (const double k : {1e9, 1e13, 1e17})
    EXPECT_LE((tip_for(k) - rigid).norm(), (1e5 / k + 1e-12) * rigid.norm()) << k;
}

// Three rods with ball joints at both ends to one point that cannot turn: each rod spins idly.
Model tripod(bool platform_turns) {
  Model m;
  const int ground = m.add_node("ground", Vector3::Zero());
  const int platform = m.add_node("platform", {0, 0, 0.3});
  struct Rod {
    int low, high;
    Matrix3 R;
  };
  std::vector<Rod> rods;
  for (int i = 0; i < 3; ++i) {
    const double a = 2 * pi * i / 3;
    const Vector3 foot(0.2 * std::cos(a), 0.2 * std::sin(a), 0), top(0.01 * std::cos(a), 0.01 * std::sin(a), 0.3);
    const int low = m.add_node("foot", foot), high = m.add_node("top", top);
    const Matrix3 R = axes_along_x(top - foot, Vector3::UnitZ());
    m.add_beam(low, high, R, {1e6, 40, 40, 30, none, none}, "rod " + std::to_string(i + 1), "rod");
    rods.push_back({low, high, R});
  }
  std::array<ConnectionFreedom, 6> ball, universal;
  for (const std::size_t i : {3u, 4u, 5u}) ball[i].rigid = false;
  for (const std::size_t i : {4u, 5u}) universal[i].rigid = false;  // x along the rod: the spin is held
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string name = "joint " + std::to_string(i + 1);
    const auto node = [&m](int n) { return m.nodes[static_cast<std::size_t>(n)].position; };
    m.connect(ground, rods[i].low, node(rods[i].low), rods[i].R, ball, name + " low", "");
    m.connect(rods[i].high, platform, node(rods[i].high), rods[i].R, platform_turns ? universal : ball, name + " high",
              "");
  }
  m.fix(ground, "ground");
  if (!platform_turns)
    for (const int i : {3, 4, 5}) m.constraints.push_back({{{6 * platform + i, 1}}, 0, "platform kept upright"});
  return m;
}

TEST(Stability, RodsThatSpinIdlyAreHeldAndSaidSo) {
  const Model m = tripod(false);
  Solver solver(m);
  ASSERT_EQ(solver.notes().size(), 3u);
  EXPECT_NE(solver.notes()[0].find("spins idly about its own axis: harmless, held"), std::string::npos);
  VectorX load = VectorX::Zero(m.dofs());
  load(6 + 2) = 100;
  const Solution s = solver.solve(load);
  EXPECT_TRUE(s.converged);
  // Three rods of length L, EA = 1e6 N, inclined: u = F L / (3 EA cos²).
  const double L = (Vector3(0.2, 0, 0) - Vector3(0.01, 0, 0.3)).norm(), cosine = 0.3 / L;
  EXPECT_NEAR(s.u(6 + 2), 100 * L / (3e6 * cosine * cosine), 1e-12 * s.u(8) * 1e3);
}

TEST(Stability, ALoadThatDrivesAnIdleSpinIsRefused) {
  const Model m = tripod(false);
  Solver solver(m);
  VectorX load = VectorX::Zero(m.dofs());
  const Vector3 along = m.beams[1].R_WM.col(0), across = m.beams[1].R_WM.col(1);
  load.segment<3>(6 * m.beams[1].a + 3) = 0.1 * along;
  try {
    solver.solve(load);
    FAIL();
  } catch (const ModelError& e) {
    EXPECT_NE(std::string(e.what()).find("rod 2 spins idly about its own axis, and the load drives this motion"),
              std::string::npos);
  }
  load.segment<3>(6 * m.beams[1].a + 3) = 0.1 * across;  // bends the rod, does not spin it
  EXPECT_TRUE(solver.solve(load).converged);
}

TEST(Stability, APlatformFreeToTurnIsRefusedWithItsThreeScrews) {
  try {
    Solver solver(tripod(true));
    FAIL();
  } catch (const ModelError& e) {
    const std::string what = e.what();
    EXPECT_NE(what.find("3 motions that nothing resists"), std::string::npos) << what;
    EXPECT_NE(what.find("node 'platform' turns about"), std::string::npos) << what;
    EXPECT_NE(what.find("To hold it, lock or spring one of: joint"), std::string::npos) << what;
  }
}

TEST(Stability, OfManyBodiesThreeAreNamedAndTheOthersCounted) {
  Model m;
  FreeMotion motion;
  for (int i = 0; i < 5; ++i) {
    m.add_node("n", {0.1 * i, 0, 0});
    motion.bodies.push_back({"rod " + std::to_string(i + 1), {i}, {true, Vector3::UnitX(), Vector3::Zero(), 0}});
  }
  const std::string text = describe(m, motion);
  EXPECT_NE(text.find("rod 3"), text.npos) << text;
  EXPECT_EQ(text.find("rod 4"), text.npos) << text;
  EXPECT_NE(text.find("; and 2 more bodies"), text.npos) << text;
}

TEST(Stability, ScrewOfAMotion) {
  // Turning about the z axis through (1, 2, 0) with 0.3 m/rad, seen at the origin.
  const Vector3 w(0, 0, 2), c(1, 2, 0), v = w.cross(-c) + 0.3 * w;
  const Screw s = screw_of(Vector3::Zero(), v, w);
  EXPECT_LE((s.axis - Vector3::UnitZ()).norm(), 1e-15);
  EXPECT_LE((s.point - c).norm(), 1e-15);
  EXPECT_NEAR(s.pitch, 0.3, 1e-15);
  EXPECT_TRUE(screw_of(Vector3::Zero(), {0, 3, 0}, Vector3::Zero()).translation);
}

/// A rod of 0.1 m on a hinge whose spring is somebody's units, k Nm/rad.
Model rod_on_a_soft_hinge(double k) {
  Model m;
  m.add_node("ground", Vector3::Zero());
  m.add_node("root", Vector3::Zero());
  m.add_node("tip", {0.1, 0, 0});
  m.add_beam(1, 2, Matrix3::Identity(), {1e6, 40, 40, 30, none, none}, "rod", "rod");
  m.fix(0, "ground");
  std::array<ConnectionFreedom, 6> hinge;
  hinge[5] = {false, {LinearSpring{k}}};
  hinge[5].laws[0].rotation = true;
  m.connect(0, 1, Vector3::Zero(), Matrix3::Identity(), hinge, "hinge", "hinge");
  return m;
}

TEST(Stability, ATooSoftSpringCostsNoDigits) {
  for (const double k : {1e3, 1e-3, 1e-12, 1e-15}) {
    Solver solver(rod_on_a_soft_hinge(k));
    VectorX load = VectorX::Zero(18);
    load(13) = 1e-15;  // N across the tip: the hinge turns by F L/k, the rod bends by F L³/3EI
    EXPECT_NEAR(solver.solve(load).u(13) / (1e-15 * (0.01 / k + 1e-3 / 120)), 1, 1e-12) << k;
  }
}

TEST(Stability, TheSoftestPartIsNamedBesideTheStiffest) {
  const Model m = rod_on_a_soft_hinge(1e-12);
  VectorX turned = VectorX::Zero(18);  // about the hinge
  turned(11) = turned(17) = 1, turned(13) = 0.1;
  const std::string text = explain_condition(m, turned, 1e-14);
  EXPECT_NE(text.find("ill-conditioned"), std::string::npos) << text;
  EXPECT_NE(text.find("'hinge rz' is too soft beside 'rod'"), std::string::npos) << text;
}

TEST(Stability, NothingIsSupported) {
  Model m;
  m.add_node("a", Vector3::Zero());
  m.add_node("b", {0.3, 0.1, 0});
  m.add_beam(0, 1, axes_along_x({0.3, 0.1, 0}, Vector3::UnitZ()), {1e6, 40, 40, 30, none, none}, "beam", "");
  try {
    Solver solver(m);
    FAIL();
  } catch (const ModelError& e) {
    EXPECT_NE(std::string(e.what()).find("6 motions"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("support node 'a'"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace deflect::frame
