// What nothing resists: counted from the kinematics alone, whatever the sizes, units and stiffnesses.
#include "msa/frame/structure/mobility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "msa/base/error.h"
#include "msa/frame/file/frame_analysis.h"
#include "msa/frame/file/frame_file.h"
#include "msa/frame/structure/solver.h"
#include "msa/frame/structure/stability.h"

namespace deflect::frame {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

BeamRigidity rod(double factor) { return {1e6 * factor, 40 * factor, 40 * factor, 30 * factor, none, none}; }

/// Clamped, hinged in the middle about z; the right half ends free. Turned by R, scaled by `size`.
Model hinged(double size, const Matrix3& R, double stiffer) {
  Model m;
  for (const double x : {0.0, 0.5, 0.5, 1.0}) m.add_node("n", R * Vector3(1.3 + size * x, size * 0.2 * x, 0.7));
  const Matrix3 axes = axes_along_x(m.nodes[1].position - m.nodes[0].position, R.col(2));
  m.add_beam(0, 1, axes, rod(1), "left", "");
  m.add_beam(2, 3, axes, rod(stiffer), "right", "");
  m.fix(0, "wall");
  std::array<ConnectionFreedom, 6> hinge;
  hinge[5].rigid = false;
  m.connect(1, 2, m.nodes[1].position, R, hinge, "hinge", "");
  return m;
}

TEST(Mobility, IsTheSameForAnySizeDirectionAndStiffness) {
  const Matrix3 turned = rotation_from_rpy(0.3, -1.1, 2.2);
  for (const double size : {1e-3, 1.0, 1e3})
    for (const Matrix3& R : {Matrix3(Matrix3::Identity()), turned})
      for (const double stiffer : {1e-12, 1.0, 1e12}) {
        const Mobility mobility = mobility_of(hinged(size, R, stiffer), {});
        EXPECT_EQ(mobility.free.cols(), 1) << size << " " << stiffer;
        EXPECT_TRUE(mobility.idle.empty());
        EXPECT_LT(mobility.largest_free, 1e-12);
        EXPECT_GT(mobility.smallest_held, 1e-2);
        EXPECT_THROW(Solver(hinged(size, R, stiffer)), CannotStand);
      }
}

TEST(Mobility, AHingeOutOfLineByLittleIsHeldAndSaid) {
  // A bar hinged at three points that are nearly in line, between two supports: h/L decides how well it is held.
  const auto bars = [](double height) {
    Model m;
    for (const Vector3& p : {Vector3(0, 0, 0), Vector3(1, height, 0), Vector3(2, 0, 0)}) m.add_node("n", p);
    for (const int i : {0, 1}) {
      const Vector3 along =
          m.nodes[static_cast<std::size_t>(i) + 1].position - m.nodes[static_cast<std::size_t>(i)].position;
      LinearForm form;  // elongation of a bar
      for (int k = 0; k < 3; ++k) {
        form.push_back({6 * (i + 1) + k, along.normalized()(k)});
        form.push_back({6 * i + k, -along.normalized()(k)});
      }
      m.springs.push_back({form, LinearSpring{1e6}, "bar", "bar"});
    }
    m.fix(0, "left"), m.fix(2, "right");
    for (const int i : {2, 3, 4, 5}) m.constraints.push_back({{{6 + i, 1}}, 0, "plane"});
    return m;
  };
  const std::vector<char> both(2, 1);
  EXPECT_EQ(mobility_of(bars(0), both).free.cols(), 1);
  for (const double height : {1e-2, 1e-5, 1e-8}) {
    const Mobility mobility = mobility_of(bars(height), both);
    EXPECT_EQ(mobility.free.cols(), 0) << height;
    EXPECT_NEAR(mobility.smallest_held / height, 1, 0.5) << height;
  }
  // Two springs k at the slope h: F = 2 k h² u.
  const double height = 1e-5;
  Solver solver(bars(height));
  VectorX load = VectorX::Zero(18);
  load(7) = 1e-6;
  EXPECT_NEAR(solver.solve(load).u(7) * 2e6 * height * height / 1e-6, 1, 1e-9);
  EXPECT_TRUE(solver.notes().empty());
  const Solver flat(bars(1e-7));
  ASSERT_FALSE(flat.notes().empty());
  EXPECT_NE(flat.notes()[0].find("nearly a mechanism"), std::string::npos) << flat.notes()[0];
}

/// A tripod of bars from the ground to one node, 1 m high, feet at 0.5 m.
const char* tripod = R"(
name: tripod
materials: {steel: {E: 200 GPa, nu: 0.3}}
sections: {rod: {shape: round, diameter: 20 mm}}
nodes: {top: [0 m, 0 m, 1 m], a: [0.5 m, 0 m, 0 m], b: [-0.25 m, 0.433012701892219 m, 0 m], c: [-0.25 m, -0.433012701892219 m, 0 m]}
members:
  A: {from: a, to: top, section: rod, material: steel, TRUSS}
  B: {from: b, to: top, section: rod, material: steel, TRUSS}
  C: {from: c, to: top, section: rod, material: steel, TRUSS}
supports: {a: pinned, b: pinned, c: pinned}
loads: {down: {nodes: {top: {fz: -1 kN}}}}
)";

FrameDescription with(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != text.npos; at = text.find(from)) text.replace(at, from.size(), to);
  return parse_frame(text, "tripod.yaml");
}

// A rack that drives a rotor through a pinion: the free motion keeps what couples them.
TEST(Mobility, AFreeMotionKeepsEveryConstraint) {
  Model m;
  m.add_node("rack", {0.3, 0, 0});
  m.add_node("end", {0.3, 0.4, 0});
  m.add_beam(0, 1, Matrix3::Identity(), rod(1), "rack", "");
  m.scalars = {"rotor", "fan"};
  for (int i = 0; i < 5; ++i) m.constraints.push_back({{{i, 1}}, 0, "guide"});
  m.constraints.push_back({{{6, 1}, {12, -0.05}}, 0, "pinion"});
  m.constraints.push_back({{{12, 1}, {13, -7}}, 0, "gear"});
  const Mobility mobility = mobility_of(m, {});
  ASSERT_EQ(mobility.free.cols(), 1);
  const VectorX u = mobility.free.col(0);
  EXPECT_GT(std::abs(u(5)), 1e-3 * u.norm());
  for (const Constraint& c : m.constraints) EXPECT_NEAR(evaluate(c.form, u), 0, 1e-12 * u.norm()) << c.name;
  EXPECT_NEAR(u(6), -0.4 * u(5), 1e-12 * u.norm()) << "the rack turns about its lower end";
}

// A rotation is held by a condition that has the rounding of a force in it.
TEST(Mobility, TheRoundingOfAForceIsNoLeverArm) {
  Model m;
  m.add_node("a", Vector3::Zero());
  for (int i = 0; i < 6; ++i) {
    LinearForm form = {{i, 1}};
    if (i >= 3) form.push_back({i - 3, 1e-17});
    m.constraints.push_back({form, 0, "hold"});
  }
  EXPECT_EQ(mobility_of(m, {}).free.cols(), 0);
}

TEST(Mobility, ATrussWorks) {
  const double L = std::sqrt(1.25), EA = 200e9 * pi * 1e-4, down = 1e3 * L / (3 * EA * (1 / 1.25));
  for (const std::string hinged : {"truss: true", "release_from: [rx, ry, rz], release_to: [rx, ry, rz]",
                                   "release_from: [ry, rz], release_to: [rx, ry, rz]"}) {
    const FrameResult r = analyse(with(tripod, "TRUSS", hinged));
    EXPECT_EQ(failed_check(r), "");
    EXPECT_NEAR(r.cases[0].displacements[0](2) / -down, 1, 1e-12) << hinged;
    EXPECT_NEAR(r.cases[0].members[0].start(0), -1e3 * L / 3, 1e-9);
    EXPECT_FALSE(r.notes.empty());
  }
}

TEST(Mobility, AMomentOnAHingedNodeIsRefused) {
  FrameDescription f = with(tripod, "TRUSS", "truss: true");
  f.loads[0].second.nodes[0].second(4) = 5;
  EXPECT_THROW((void)analyse(f), ModelError);
}

TEST(Mobility, APlaneFrameStandsInItsPlane) {
  const std::string text = R"(
name: plane
PLANE
materials: {steel: {E: 200 GPa, nu: 0.3}}
sections: {rod: {shape: round, diameter: 20 mm}}
nodes: {a: [0 m, 0 m, 0 m], b: [1 m, 0 m, 0 m], c: [0.5 m, 0 m, 0.5 m]}
members:
  A: {from: a, to: b, section: rod, material: steel, truss: true}
  B: {from: b, to: c, section: rod, material: steel, truss: true}
  C: {from: c, to: a, section: rod, material: steel, truss: true}
supports: {a: [ux, uz], b: [uz]}
loads: {down: {nodes: {c: {fz: -1 kN}}}}
)";
  EXPECT_THROW((void)analyse(with(text, "PLANE\n", "")), CannotStand);
  const FrameResult r = analyse(with(text, "PLANE", "plane: xz"));
  EXPECT_EQ(failed_check(r), "");
  EXPECT_NEAR(r.cases[0].members[0].start(0), 500, 1e-9);
  FrameDescription across = with(text, "PLANE", "plane: xz");
  across.loads[0].second.nodes[0].second(1) = 1;
  EXPECT_THROW((void)analyse(across), InputError);
}

}  // namespace
}  // namespace deflect::frame
