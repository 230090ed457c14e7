// Deformed shapes of frames in which no force acts, or none that moves a node: what rounding leaves is no failure.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "msa/frame/deformed/geometric_solver.h"
#include "msa/frame/file/frame_case.h"
#include "tests/support/frames.h"

namespace deflect::frame {
namespace {

using test::Solved;

constexpr double EI = 200, GJ = 240;  // Nm², of `skew` about both axes

/// Supports of A, the loads and what else is given; A and B are the ends of a beam askew in all axes, of 0.7874… m.
std::string skew(const std::string& geometry, const std::string& supports, const std::string& load,
                 const std::string& end = "", int elements = 1) {
  return fmt::format(R"(name: skew
geometry: {}
materials: {{steel: {{E: 200 GPa, G: 80 GPa, expansion: 1e-5 1/K}}}}
sections: {{rod: {{shape: given, A: 100 mm^2, Iy: 1000 mm^4, Iz: 1000 mm^4, J: 3000 mm^4}}}}
nodes: {{A: [0 mm, 0 mm, 0 mm], B: [700 mm, 300 mm, 200 mm]}}
members: {{beam: {{from: A, to: B, section: rod, material: steel, elements: {}{}}}}}
supports: {}
loads: {{load: {}}}
)",
                     geometry, elements, end, supports, load);
}

const Vector3 line(0.7, 0.3, 0.2);  // m
const Vector3 across = line.cross(Vector3::UnitZ()).normalized();

std::string vector_of(const Vector3& v, const char* unit, const char* names) {
  return fmt::format("{{{0}x: {1:.17g} {4}, {0}y: {2:.17g} {4}, {0}z: {3:.17g} {4}}}", names, v.x(), v.y(), v.z(),
                     unit);
}

/// The largest force and moment of the only member, N and Nm.
double force_in(const Solved& s) { return s.member("beam").start.cwiseAbs().maxCoeff(); }

// θ = M L/EI. Second order: no force, so the tip moves by θ L/2 as in the linear theory; finite: along an arc of the
// radius L/θ, which an element follows to (θ/n)²/24, here that of 32.
TEST(GeometricRounding, AnEndMomentBendsASkewCantileverToAnArc) {
  const double L = line.norm();
  for (const double theta : {1e-6, 0.1, pi / 2}) {
    const std::string load = "{nodes: {B: " + vector_of(theta * EI / L * across, "Nm", "m") + "}}";
    const Vector3 side = across.cross(line / L);  // to which the tip goes
    const Solved second(parse_frame(skew("second-order", "{A: clamped}", load), "t"));
    ASSERT_EQ(failed_check(second.result), "") << theta;
    const Solved finite(parse_frame(skew("finite\nload_steps: 4", "{A: clamped}", load, "", 32), "t"));
    ASSERT_EQ(failed_check(finite.result), "") << theta;
    EXPECT_LT((finite.u("B").tail<3>() - theta * across).norm(), 1e-9 * theta) << theta;
    const Vector3 arc =
        L * ((std::sin(theta) / theta - 1) * line / L + 2 * std::pow(std::sin(theta / 2), 2) / theta * side);
    EXPECT_LT((finite.u("B").head<3>() - arc).norm(), std::max(theta * theta / (24 * 32 * 32), 1e-9) * theta * L);
    // Digits: bending is EA L²/EI = 62000 times softer than stretching, which the skew axes mix.
    if (theta > 0.2) continue;  // the moment has a geometric stiffness, of no consequence in the plane
    EXPECT_LT((second.u("B").tail<3>() - theta * across).norm(), 1e-9 * theta) << theta;
    EXPECT_LT((second.u("B").head<3>() - theta * L / 2 * side).norm(), 1e-9 * theta * L) << theta;
  }
}

// A foot that moves takes a cantilever along as a rigid body. Second order: its rotation is a small one.
TEST(GeometricRounding, AMovedFootMovesTheFrameWithoutForces) {
  const Vector3 turn(0, 0.5, 0);
  const std::string load = "{displacements: {A: {ry: 0.5 rad, uz: 1 mm}}}";
  const Matrix3 R = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  for (const std::string geometry : {"second-order", "finite"})
    for (const int elements : {1, 4}) {
      const Solved s(parse_frame(skew(geometry, "{A: clamped}", load, "", elements), "t"));
      ASSERT_EQ(failed_check(s.result), "") << geometry;
      const Vector3 moved = geometry == "finite" ? Vector3(R * line - line) : turn.cross(line);
      EXPECT_LT((s.u("B").head<3>() - Vector3(0, 0, 1e-3) - moved).norm(), 1e-12) << geometry;
      EXPECT_LT((s.u("B").tail<3>() - turn).norm(), 1e-12) << geometry;
      EXPECT_LT(force_in(s), 1e-13 * 2e7) << geometry;  // 450 ε of EA
    }
}

// Two bars of the length l are h apart at their feet' height below C. Warmer by ΔT they lift it: to sqrt(l'² − b²)
// in finite geometry, by α ΔT l²/h in the linear and the second-order theory.
TEST(GeometricRounding, AHeatedDeterminateTrussHasNoForces) {
  for (const std::string geometry : {"second-order", "finite"})
    for (const double heat : {30.0, 2000.0}) {
      const Solved s(parse_frame(fmt::format(R"(name: truss
geometry: {}
plane: xz
materials: {{steel: {{E: 200 GPa, G: 80 GPa, expansion: 1e-5 1/K}}}}
sections: {{rod: {{shape: given, A: 100 mm^2, Iy: 1000 mm^4, Iz: 1000 mm^4, J: 3000 mm^4}}}}
nodes: {{A: [0 m, 0 m, 0 m], B: [2 m, 0 m, 0 m], C: [1 m, 0 m, 0.7 m]}}
members:
  beam: {{from: A, to: C, section: rod, material: steel, truss: true}}
  other: {{from: B, to: C, section: rod, material: steel, truss: true}}
supports: {{A: [ux, uz], B: [ux, uz]}}
loads: {{sun: {{temperature: {{beam: {} K, other: {} K}}}}}}
)",
                                             geometry, heat, heat),
                                 "t"));
      ASSERT_EQ(failed_check(s.result), "") << geometry;
      const double l2 = 1.49, strain = 1e-5 * heat, longer = (1 + strain) * (1 + strain) * l2;
      const double lift = geometry == "finite" ? std::sqrt(longer - 1) - 0.7 : strain * l2 / 0.7;
      EXPECT_NEAR(s.u("C")(2), lift, 1e-10 * lift) << geometry << heat;
      EXPECT_LT(force_in(s), 1e-10 * 2e7 * strain) << geometry << heat;  // of what heat gives where nothing yields
    }
}

// Clamped at both ends, but for an end that yields about one axis: about the axis of the bar nothing turns it, about z
// the end turns by θ = q L³/(12 (4 EI/L + k) …): M_clamped = q L²/12 = (4 EI/L + k) θ.
TEST(GeometricRounding, ABeamBetweenClampedEndsStandsOnASpring) {
  const double L = line.norm(), q = 10, k = 1000;  // N/m, Nm/rad
  for (const std::string geometry : {"second-order", "finite"})
    for (const std::string freedom : {"rx", "tx", "ty", "rz"})
      for (const std::string load :
           {"{members: {beam: {qy: 0.01 N/mm, axes: member}}}", "{temperature: {beam: -1 K}}"}) {
        const bool turns = freedom[0] == 'r';
        const std::string end =
            fmt::format(", end: {{{}: {{law: linear, stiffness: {}}}}}", freedom, turns ? "1000 Nm/rad" : "1e6 N/mm");
        const Solved s(parse_frame(skew(geometry, "{A: clamped, B: clamped}", load, end), "t"));
        ASSERT_EQ(failed_check(s.result), "") << geometry << freedom << load;
        const bool heated = load.find("temp") != std::string::npos;
        const Vector6& at = s.member("beam").end;
        const double force = heated ? 200 : q * L, digits = 1e-9;
        const double N = heated ? 200 / (freedom == "tx" ? 1 + 2e7 / L / 1e9 : 1) : 0;  // EA α ΔT, in series with k
        const bool bends = freedom == "rz" && geometry == "finite";                     // its shortening pulls
        if (!bends) {
          EXPECT_NEAR(at(0), N, digits * force) << geometry << freedom << load;
        }
        if (heated || freedom == "ty") continue;
        const double M = freedom == "rz" ? k / (4 * EI / L + k) : 1;
        // In the deformed shape to the square of the rotation, (q L²/12/(4 EI/L))² = 3e-7.
        EXPECT_NEAR(std::abs(at(5)), M * q * L * L / 12, 1e-6 * q * L * L) << geometry << freedom << load;
      }
}

// Two members from ball joints at C and F meet at A: all of it turns about CF within the play at C, which nothing
// drives where a free end is warmer or both supports move alike. A light load drives it through the play.
TEST(GeometricRounding, PlayThatNothingDrivesStandsInItsMiddle) {
  const auto frame = [](const std::string& geometry, const std::string& load) {
    return fmt::format(R"(name: swing
geometry: {}
materials: {{steel: {{E: 30 GPa, G: 11 GPa, expansion: 1e-5 1/K}}}}
sections: {{rod: {{shape: given, A: 50 mm^2, Iy: 250 mm^4, Iz: 60 mm^4, J: 200 mm^4}}}}
nodes: {{A: [372.6 mm, 197.4 mm, 1.9 mm], B: [193.7 mm, 387.3 mm, -193.7 mm], C: [193.7 mm, -387.3 mm, 387.3 mm],
        F: [-204.2 mm, 285.5 mm, -177.6 mm]}}
members:
  from_C: {{from: C, to: A, section: rod, material: steel}}
  to_F: {{from: A, to: F, section: rod, material: steel}}
  tip: {{from: A, to: B, section: rod, material: steel}}
supports:
  F: pinned
  C: {{holds: pinned, ry: [{{law: clearance, gap: 1e-3 rad}}, {{law: linear, stiffness: 40 Nm/rad}}]}}
loads: {{load: {{{}}}}}
)",
                       geometry, load);
  };
  const std::string heat = "temperature: {tip: -20 K}", move = "{ux: 1 mm, uy: 1 mm, uz: 1 mm}";
  const std::string settle = "displacements: {C: " + move + ", F: " + move + "}";
  for (const std::string geometry : {"linear", "second-order", "finite"}) {
    for (const std::string& load : {heat, settle, "factor: 1e-6, " + heat, "factor: 1e-6, " + settle}) {
      const Solved s(parse_frame(frame(geometry, load), "t"));
      ASSERT_EQ(failed_check(s.result), "") << geometry << load;
      const double part = load[0] == 'f' ? 1e-6 : 1, moved = load.find("ux") != std::string::npos ? part * 1e-3 : 0;
      EXPECT_LT((s.u("A").head<3>() - Vector3::Constant(moved)).norm(), 1e-12) << geometry << load;
      EXPECT_LT(s.u("A").tail<3>().norm(), 1e-12) << geometry << load;
      EXPECT_EQ(s.result.notes,
                std::vector{std::string("load case 'load': support C ry [1] floats in its play, of which the middle "
                                        "is given")})
          << geometry << load;
    }
    for (const std::string& load : {heat, settle}) {
      const Solved s(parse_frame(frame(geometry, load + ", nodes: {A: {fx: 1e-3 N}}"), "t"));
      ASSERT_EQ(failed_check(s.result), "") << geometry << load;
      EXPECT_GT(std::abs(s.u("C")(4)), 1e-3) << geometry << load;
      EXPECT_TRUE(s.result.notes.empty()) << geometry << load;
    }
  }
}

// A piece of s at the tip of a beam of 1 m: rigid, but for the levers of its end. Its stiffness EI/s³ times the
// rounding of the tip's displacement is far more than the load. The shorter it is, the less it changes: u(s) = u(0) +
// O(s).
TEST(GeometricRounding, AShortPieceAtTheTipOfABeamIsARigidOne) {
  const auto solved = [](const std::string& geometry, double s) {
    return Solved(parse_frame(fmt::format(R"(name: tip
geometry: {}
materials: {{steel: {{E: 200 GPa, G: 80 GPa}}}}
sections: {{rod: {{shape: given, A: 100 mm^2, Iy: 2000 mm^4, Iz: 800 mm^4, J: 500 mm^4, As_y: 80 mm^2, As_z: 60 mm^2}}}}
nodes: {{A: [0 mm, 0 mm, 0 mm], B: [1000 mm, 0 mm, 0 mm], C: [1000 mm, {} mm, {} mm]}}
members:
  beam: {{from: A, to: B, section: rod, material: steel}}
  piece: {{from: B, to: C, section: rod, material: steel}}
supports: {{A: clamped}}
loads: {{load: {{nodes: {{C: {{fz: 1 N, fx: 3 N}}}}}}}}
)",
                                          geometry, 0.6 * s, 0.8 * s),
                              "t"));
  };
  for (const std::string geometry : {"second-order", "finite"}) {
    const Solved far = solved(geometry, 1), farther = solved(geometry, 2);
    const Vector6 by_s = farther.u("B") - far.u("B"), none = far.u("B") - by_s;
    for (const double s : {0.3, 0.1, 0.07, 0.05, 0.04, 0.03, 0.02, 0.015, 0.01}) {
      const Solved at = solved(geometry, s);
      ASSERT_EQ(failed_check(at.result), "") << geometry << s;
      EXPECT_LT((at.u("B") - none - s * by_s).norm(), 1e-6 * none.norm()) << geometry << s;
      EXPECT_NEAR(at.u("B")(3), s * by_s(3), 5e-4 * s * by_s(3)) << geometry << s;  // the twist, 1e-4 of the rest
      const double missing = (at.member("piece").end.head<3>().norm() - std::sqrt(10.0)) / std::sqrt(10.0);
      const bool told = std::any_of(at.result.notes.begin(), at.result.notes.end(), [](const std::string& note) {
        return note.find("the forces of members balance to") != std::string::npos;
      });
      EXPECT_TRUE(told || std::abs(missing) < 2e-3) << geometry << s << ' ' << missing;
      EXPECT_TRUE(s < 0.06 || !told) << geometry << s;
      EXPECT_TRUE(s > 0.02 || told) << geometry << s;
    }
    // Where doubles have no digits left, the message says so and names the piece.
    for (const double s : {1e-3, 1e-4}) {
      const std::string refused = failed_check(solved(geometry, s).result);
      EXPECT_NE(refused.find("In the deformed shape the stiffness is ill-conditioned"), std::string::npos) << refused;
      EXPECT_NE(refused.find("'beam' is too soft beside 'piece'"), std::string::npos) << refused;
    }
  }
}

// Small moments, heat and settlements of trees of members: the theories differ by the rotation and the strain, here
// 1e-5 of the motion at most, as a chain of up to six members adds up what each one's 1e-6 turns.
TEST(GeometricRounding, SmallMomentsHeatAndSettlementsEqualTheLinearTheory) {
  std::mt19937 random(5);
  const auto uniform = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  for (int i = 0; i < 60; ++i) {
    std::string nodes = "N0: [0 m, 0 m, 0 m]", members, heat;
    for (int n = 1; n <= 6; ++n) {
      const int from = std::uniform_int_distribution<int>(0, n - 1)(random);
      nodes += fmt::format(", N{}: [{} m, {} m, {} m]", n, n + uniform() / 4, uniform(), uniform());
      members += fmt::format("  m{0}: {{from: N{1}, to: N{0}, section: rod, material: steel}}\n", n, from);
      heat += fmt::format("{}m{}: {} K", n > 1 ? ", " : "", n, 0.1 * uniform());
    }
    const std::string loads[] = {
        "nodes: {N6: " + vector_of(1e-4 * Vector3(uniform(), uniform(), uniform()), "Nm", "m") + "}",
        "temperature: {" + heat + "}",
        fmt::format("displacements: {{N0: {{rx: {} rad, uy: {} mm}}}}", 1e-6 * uniform(), uniform())};
    for (const std::string& load : loads) {
      const auto solved = [&](const std::string& geometry) {
        return Solved(parse_frame(
            fmt::format(
                "name: tree\ngeometry: {}\nmaterials: {{steel: {{E: 200 GPa, G: 80 GPa, expansion: 1e-5 1/K}}}}\n"
                "sections: {{rod: {{shape: given, A: 100 mm^2, Iy: 1000 mm^4, Iz: 2000 mm^4, J: 3000 mm^4}}}}\n"
                "nodes: {{{}}}\nmembers:\n{}supports: {{N0: clamped}}\nloads: {{load: {{{}}}}}\n",
                geometry, nodes, members, load),
            "t"));
      };
      const VectorX linear = solved("linear").result.cases[0].u;
      for (const char* geometry : {"second-order", "finite"}) {
        const Solved s = solved(geometry);
        EXPECT_EQ(failed_check(s.result), "") << i << geometry << load;
        EXPECT_LT((s.result.cases[0].u.head(linear.size()) - linear).norm(), 1e-5 * linear.norm())
            << i << geometry << load;
      }
    }
  }
}

// The sum of loads and reactions is wrong by 2e-6 of both, where a reaction is by 4e-6: this is told, and not taken for
// rounding of the members' forces, which the axial stiffness of a slender member makes 10⁵ times larger.
TEST(GeometricRounding, AWrongReactionIsTold) {
  for (const std::string geometry : {"second-order", "finite"}) {
    const FrameDescription f = parse_frame(skew(geometry, "{A: clamped}", "{nodes: {B: {fz: 1 N}}}"), "t");
    FrameModel m = build_frame(f, {});
    GeometricSolver solver(m.model);
    m.model = solver.model();
    GeometricOptions options;
    options.geometry = f.geometry;
    const VectorX loads = load_of(f, m, "load", f.loads[0].second).forces;
    GeometricState state = solver.solve({loads, {}, {}}, options);
    ASSERT_TRUE(state.converged);
    EXPECT_LT(resultant(m, state, loads), 1e-9);
    state.constraint_forces *= 1 + 4e-6;
    EXPECT_GT(resultant(m, state, loads), check_tolerance);
  }
}

}  // namespace
}  // namespace deflect::frame
