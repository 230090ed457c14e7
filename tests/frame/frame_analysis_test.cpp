// What the parts of a frame file do, each against a closed form; and the checks of the analysis on all of them.
#include "msa/frame/file/frame_analysis.h"

#include <gtest/gtest.h>

#include "msa/base/error.h"
#include "tests/support/frames.h"

namespace deflect::frame {
namespace {

using test::Solved;

const std::string head = R"(name: test
materials:
  steel: {E: 200 GPa, nu: 0.25, density: 8000 kg/m^3, expansion: 1e-5 1/K}
sections:
  rod: {shape: given, A: 100 mm^2, Iy: 2000 mm^4, Iz: 1000 mm^4, J: 3000 mm^4}
nodes:
  a: [0 mm, 0 mm, 0 mm]
  b: [1000 mm, 0 mm, 0 mm]
  c: [2000 mm, 0 mm, 0 mm]
)";
constexpr double E = 200e9, G = 80e9, A = 1e-4, Iy = 2e-9, Iz = 1e-9, J = 3e-9;
const std::string span = R"(members:
  left: {from: a, to: b, section: rod, material: steel}
  right: {from: b, to: c, section: rod, material: steel}
)";

Solved solve(const std::string& rest) {
  Solved s(parse_frame(head + rest, "test"));
  EXPECT_EQ(failed_check(s.result), "");
  for (const CaseResult& c : s.result.cases) {
    EXPECT_LT(c.checks.residual, 1e-9) << c.name;
    EXPECT_LT(c.checks.equilibrium, 1e-9) << c.name;
    EXPECT_LT(c.checks.energy, 1e-9) << c.name;
  }
  EXPECT_LT(s.result.reciprocity, 1e-9);
  return s;
}

/// To 1e-9 of what is expected: the frames here are small and stiff in nothing.
void expect_same(double value, double expected) { EXPECT_NEAR(value, expected, 1e-9 * std::abs(expected) + 1e-18); }

TEST(FrameAnalysis, SignsOfSectionForcesOnACantilever) {
  // Local y up (base z), local z = x × y = −(base y).
  const Solved s = solve(span + R"(supports: {a: clamped}
loads:
  tip: {nodes: {c: {fx: 1 N, fy: 2 N, fz: 3 N, mx: 4 Nm}}}
)");
  const Vector6 start = s.member("left").start, end = s.member("right").end;
  const Vector6 at_end = (Vector6() << 1, 3, -2, 4, 0, 0).finished();
  EXPECT_LT((end - at_end).norm(), 1e-9);
  EXPECT_LT((s.member("left").end - s.member("right").start).norm(), 1e-9);
  expect_same(start(5), 3 * 2);  // EIz v'' > 0: pulled up at the tip, curved upwards
  expect_same(start(4), 2 * 2);  // EIy w'' = −My, w along −(base y): the tip moves along −w, so w'' < 0
  expect_same(s.u("c")(2), 3 * 8 / (3 * E * Iz));
  expect_same(s.u("c")(1), 2 * 8 / (3 * E * Iy));
  expect_same(s.u("c")(3), 4 * 2 / (G * J));
  const Vector6 reaction = (Vector6() << -1, -2, -3, -4, 6, -4).finished();
  EXPECT_LT((s.reaction("a") - reaction).norm(), 1e-9);
}

TEST(FrameAnalysis, SelfWeightAndLineLoadsOfACantileverInOneElementEach) {
  const Solved s = solve(span + R"(supports: {a: clamped}
loads:
  weight: {gravity: [0 m/s^2, 0 m/s^2, -10 m/s^2]}
  base: {members: {left: {qz: -8 N/m}, right: {qz: -8 N/m}}}
  member: {members: {left: {qy: -8 N/m, axes: member}, right: {qy: -8 N/m, axes: member}}}
)");
  const double q = 8000 * A * 10;
  ASSERT_EQ(q, 8);
  for (std::size_t c = 0; c < 3; ++c) {
    expect_same(s.u("c", c)(2), -q * 16 / (8 * E * Iz));
    expect_same(s.reaction("a", c)(2), 16);
    expect_same(s.member("left", c).start(5), -16);  // −qL²/2
    expect_same(s.member("left", c).Mz.value, -16);
    EXPECT_EQ(s.member("left", c).Mz.at, 0);
    expect_same(s.result.cases[c].energy, q * q * 32 / (40 * E * Iz));  // ∫(qx²/2)²/2EI
  }
}

TEST(FrameAnalysis, LargestMomentBetweenTheEnds) {
  const Solved s = solve(span + R"(supports: {a: [ux, uy, uz, rx], b: [uy, uz], c: [uy, uz]}
loads:
  one: {members: {left: {qz: -100 N/m}}}
)");
  // Two spans, one loaded: M_b = −qL²/16, reaction at a 7qL/16, largest moment 49qL²/512 at 7L/16.
  const LargestMoment& m = s.member("left").Mz;
  expect_same(s.member("left").end(5), -100.0 / 16);
  expect_same(m.value, 100 * 49.0 / 512);
  expect_same(m.at, 7.0 / 16);
}

TEST(FrameAnalysis, NothingIsFreeToMove) {
  const Solved s = solve(span + R"(supports: {a: clamped, b: clamped, c: clamped}
loads:
  line: {members: {left: {qz: -12 N/m}, right: {qy: 7 N/m}}}
  heat: {temperature: {left: 30 K}}
  idle: {nodes: {b: {fx: 3 N}}}
)");
  expect_same(s.member("left", 0).start(5), -1);
  expect_same(s.member("left", 0).Mz.value, -1);
  expect_same(s.result.cases[0].energy, (12 * 12 / Iz + 7 * 7 / Iy) / (1440 * E));
  expect_same(s.reaction("a", 1)(0), E * A * 3e-4);
  expect_same(s.reaction("b", 2)(0), -3);
}

TEST(FrameAnalysis, TemperatureFreeAndHeld) {
  const Solved s = solve(span + R"(supports: {a: clamped}
loads:
  free: {temperature: {left: 40 K, right: 40 K}}
)");
  expect_same(s.u("c")(0), 1e-5 * 40 * 2);
  EXPECT_LT(s.reaction("a").norm(), 1e-9 * E * A * 4e-4);
  EXPECT_LT(s.result.cases[0].energy, 1e-18);
  const Solved held = solve(span + R"(supports: {a: clamped, c: clamped}
loads:
  one side: {temperature: {left: 40 K}}
  both: {temperature: {left: 40 K, right: 40 K}}
)");
  expect_same(held.member("left", 0).start(0), -E * A * 4e-4 / 2);
  expect_same(held.u("b", 0)(0), 4e-4 / 2);
  expect_same(held.member("right", 1).end(0), -E * A * 4e-4);
  expect_same(held.result.cases[1].energy, E * A * 4e-4 * 4e-4 / 2 * 2);
}

TEST(FrameAnalysis, SettlementOfAClampedBeamAndOfADeterminateOne) {
  const Solved s = solve(span + R"(supports: {a: clamped, c: clamped}
loads:
  sinks: {displacements: {c: {uz: -3 mm}}}
  turns: {displacements: {c: {ry: 1 mrad}}}
  load: {nodes: {b: {fz: -5 N}}}
)");
  expect_same(s.reaction("c", 0)(2), -12 * E * Iz * 3e-3 / 8);
  expect_same(s.reaction("a", 0)(4), -6 * E * Iz * 3e-3 / 4);
  expect_same(s.u("b", 0)(2), -1.5e-3);
  expect_same(s.reaction("c", 1)(4), 4 * E * Iz * 1e-3 / 2);
  const Solved free = solve(span + R"(supports: {a: [ux, uy, uz, rx], c: [uy, uz]}
loads:
  sinks: {displacements: {c: {uz: -3 mm}}}
)");
  EXPECT_LT(free.result.cases[0].energy, 1e-18);
  expect_same(free.u("b")(2), -1.5e-3);
  expect_same(free.u("b")(4), 1.5e-3);
}

TEST(FrameAnalysis, ReleasesMakeHinges) {
  const Solved s = solve(R"(members:
  left: {from: a, to: b, section: rod, material: steel}
  right: {from: b, to: c, section: rod, material: steel, release_from: [ry, rz], release_to: rz}
supports: {a: clamped, c: [ux, uy, uz, rx, ry, rz]}
loads:
  uniform: {members: {right: {qz: -16 N/m}}}
)");
  // The right half hangs simply supported between c and the tip of the left one.
  expect_same(s.reaction("c")(2), 8);
  EXPECT_LT(std::abs(s.member("right").start(5)) + std::abs(s.member("right").end(5)), 1e-9);
  expect_same(s.u("b")(2), -8.0 / (3 * E * Iz));
  expect_same(s.member("right").Mz.value, 16.0 / 8);
}

TEST(FrameAnalysis, ReleasedSlidesAndMemberAxes) {
  // Both freedoms of the slide stand in member axes: the right part cannot carry along x.
  const Solved s = solve(R"(members:
  left: {from: a, to: b, section: rod, material: steel}
  right: {from: b, to: c, section: rod, material: steel, release_from: tx}
supports: {a: clamped, c: clamped}
loads:
  pull: {nodes: {b: {fx: 7 N, fz: 2 N}}}
)");
  expect_same(s.reaction("a")(0), -7);
  EXPECT_EQ(s.reaction("c")(0), 0);
  expect_same(s.u("b")(2), 2 * 8 / (192 * E * Iz));
}

TEST(FrameAnalysis, SpringsToGroundAndBetweenNodes) {
  const Solved s = solve(span + R"(supports: {a: clamped}
springs:
  end: {node: c, uz: 3 N/mm}
loads:
  tip: {nodes: {c: {fz: 10 N}}}
)");
  const double k = 3 * E * Iz / 8;
  expect_same(s.u("c")(2), 10 / (k + 3000));
  expect_same(s.result.cases[0].springs[0](2), -3000 * 10 / (k + 3000));
  const Named<double>& shares = s.result.cases[0].energies;
  expect_same(shares[0].second / shares[1].second, 3000 / k);
  EXPECT_EQ(shares[0].first, "end");
  // Along the line between the nodes: two springs in series with their stiffness only.
  const Solved chain = solve(R"(supports: {a: clamped, b: [uy, uz, rx, ry, rz], c: [uy, uz, rx, ry, rz]}
springs:
  one: {node: a, to: b, ux: 2 N/mm}
  two: {node: c, to: b, ux: 3 N/mm}
loads:
  pull: {nodes: {c: {fx: 6 N}}}
)");
  expect_same(chain.u("c")(0), 6.0 / 2000 + 6.0 / 3000);
  expect_same(chain.result.cases[0].springs[0](0), 6);
}

TEST(FrameAnalysis, RigidLinksWholeAndInSomeFreedoms) {
  const Solved s = solve(R"(members:
  left: {from: a, to: b, section: rod, material: steel}
supports: {a: clamped}
rigid_links:
  arm: {master: b, nodes: c}
loads:
  tip: {nodes: {c: {fz: 1 N}}}
)");
  const double tip = 1 / (3 * E * Iz) + 1 / (2 * E * Iz), turn = 1 / (2 * E * Iz) + 1 / (E * Iz);
  expect_same(s.u("b")(2), tip);
  expect_same(s.u("c")(2), tip + turn);
  EXPECT_EQ(s.result.structure.arms.size(), 1u);
  const Solved some = solve(span + R"(supports: {a: clamped, c: clamped}
rigid_links:
  same height: {master: c, nodes: b, freedoms: [uz]}
loads:
  push: {nodes: {b: {fz: -4 N, fx: 1 N}}}
)");
  EXPECT_EQ(some.u("b")(2), 0);  // c neither moves nor turns
  expect_same(some.u("b")(0), 1 / (2 * E * A));
}

TEST(FrameAnalysis, ConstraintsWithTheirForcesRedundancyAndContradiction) {
  const std::string constraints = R"(constraints:
  same: {terms: [{node: b, freedom: uz}, {node: c, freedom: uz, factor: -0.5}]}
)";
  const std::string rest = R"(supports: {a: clamped}
loads:
  tip: {nodes: {c: {fz: 5 N}}}
)";
  const Solved s = solve(span + constraints + rest);
  expect_same(2 * s.u("b")(2), s.u("c")(2));
  // Force λ on b, −λ/2 on c; EI u_b = 5·5/6 + λ (1/3 − 5/12), EI u_c = 5·8/3 + λ (5/6 − 4/3) and u_c = 2 u_b.
  expect_same(s.result.cases[0].constraints[0], (25.0 / 3 - 40.0 / 3) / (-0.5 + 1.0 / 6));
  EXPECT_TRUE(s.result.notes.empty());

  const Solved doubled =
      solve(span + constraints + R"(  again: {terms: [{node: c, freedom: uz}, {node: b, freedom: uz, factor: -2}]}
)" + rest);
  ASSERT_EQ(doubled.result.notes.size(), 1u);
  EXPECT_NE(doubled.result.notes[0].find("constraint 'again' is redundant: 'same'"), std::string::npos)
      << doubled.result.notes[0];
  expect_same(doubled.u("c")(2), s.u("c")(2));

  try {  // the arm asks c to follow b, both are held elsewhere
    analyse(parse_frame(head + span + R"(supports: {a: clamped, b: clamped, c: clamped}
rigid_links:
  arm: {master: b, nodes: c}
loads:
  tip: {displacements: {c: {uz: 5 mm}}}
)",
                        "test"));
    FAIL();
  } catch (const ModelError& e) {
    EXPECT_NE(std::string(e.what()).find("contradicts"), std::string::npos) << e.what();
  }
}

TEST(FrameAnalysis, AMechanismIsRefusedWhetherTheLoadExcitesItOrNot) {
  for (const char* force : {"fz", "fx"}) try {
      analyse(parse_frame(head + R"(members:
  left: {from: a, to: b, section: rod, material: steel, release_to: [ry, rz]}
  right: {from: b, to: c, section: rod, material: steel}
supports: {a: [ux, uy, uz, rx], c: [uy, uz]}
loads:
  load: {nodes: {b: {)" + std::string(force) +
                              ": 1 N}}}\n",
                          "test"));
      FAIL() << force;
    } catch (const ModelError& e) {
      EXPECT_NE(std::string(e.what()).find("cannot stand"), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("left"), std::string::npos) << e.what();
    }
}

TEST(FrameAnalysis, BendingFactorAndTimoshenkoActOnTheirMemberOnly) {
  const Solved s = solve(R"(members:
  left: {from: a, to: b, section: rod, material: steel, bending_factor: 0.5}
supports: {a: clamped, c: clamped}
loads:
  tip: {nodes: {b: {fz: 1 N}}}
)");
  expect_same(s.u("b")(2), 1 / (3 * 0.5 * E * Iz));
}

TEST(FrameAnalysis, ReciprocityIsSeenAcrossKindsOfLoads) {
  // Betti between force, heat, line load and moved support: 6 pairs in one number, and it is not zero by emptiness.
  const Solved s = solve(span + R"(supports: {a: clamped, c: [ux, uz]}
loads:
  force: {nodes: {b: {fz: 3 N, fy: 2 N, fx: 5 N}}}
  heat: {temperature: {left: 30 K}}
  line: {members: {right: {qz: 4 N/m, qx: 3 N/m}}}
  moved: {displacements: {c: {ux: 0.1 mm, uz: 2 mm}}}
)");
  EXPECT_GT(s.result.reciprocity, 0);
  EXPECT_LT(s.result.reciprocity, 1e-12);
  FrameResult broken = s.result;
  broken.reciprocity = 1e-3;
  EXPECT_NE(failed_check(broken), "");
  broken = s.result;
  broken.cases[2].checks.energy = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(failed_check(broken).find("load case 'line': work"), std::string::npos) << failed_check(broken);
}

// Ground that sinks under all supports strains nothing: what passes through the members is rounding, which no check may
// take for an error. Nor is it one beside a load that is as small.
TEST(FrameAnalysis, SupportsThatSettleAlikeCarryTheFrameAlong) {
  for (const char* load : {"0 N", "1e-12 N", "1 N"})
    for (const char* way : {"0.1 mm", "10 mm", "-1 m"}) {
      const Solved s =
          solve(span + "supports: {a: {holds: clamped, settled: {uz: " + way +
                "}}, c: {holds: clamped, settled: {uz: " + way + "}}}\nloads: {l: {nodes: {b: {fx: " + load + "}}}}\n");
      EXPECT_EQ(s.u("b")(2), s.u("a")(2)) << way;
      EXPECT_NEAR(std::abs(s.member("left").end(0)), load == std::string("1 N") ? 0.5 : 0, 1e-9) << load << " " << way;
      FrameOptions iterative;
      iterative.equations.solver = Equations::iterative;
      const FrameResult by_iteration = analyse(s.frame, iterative);
      EXPECT_EQ(failed_check(by_iteration), "") << load << " " << way;
    }
}

TEST(FrameAnalysis, NamesThatDoNotResolveAreRefusedWithoutAFileToo) {
  FrameDescription f =
      parse_frame(head + span + "supports: {a: clamped}\nloads: {l: {nodes: {b: {fx: 1 N}}}}\n", "test");
  FrameDescription wrong = f;
  wrong.members[1].second.to = "d";
  EXPECT_THROW(analyse(wrong), InputError);
  wrong = f;
  wrong.loads[0].second.displacements.emplace_back("c", FreedomValues{});
  EXPECT_THROW(analyse(wrong), InputError);
}

}  // namespace
}  // namespace deflect::frame
