// Laws at supports, springs and ends of members, misfits and factors: each against what two springs do, by hand.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "msa/base/error.h"
#include "msa/base/outcome.h"
#include "tests/support/frames.h"

namespace deflect::frame {
namespace {

using test::Solved;

// A cantilever of 1 m, 3EI/L³ = 3000 N/m in uz, EA/L = 1e6 N/m in ux.
constexpr double k_tip = 3000, k_along = 1e6;

std::string cantilever(const std::string& rest, const std::string& more_of_beam = "") {
  return "name: cantilever\n"
         "materials: {steel: {E: 1 GPa, nu: 0.25, expansion: 1e-5 1/K}}\n"
         "sections: {rod: {shape: given, A: 1000 mm^2, Iy: 1e6 mm^4, Iz: 1e6 mm^4, J: 3000 mm^4}}\n"
         "nodes: {A: [0 mm, 0 mm, 0 mm], B: [1000 mm, 0 mm, 0 mm]}\n"
         "members: {beam: {from: A, to: B, section: rod, material: steel" +
         more_of_beam + "}}\n" + rest;
}

Solved solve(const std::string& text, const FrameOptions& options = {}) {
  Solved s(parse_frame(text, "test"), options);
  EXPECT_EQ(failed_check(s.result), "");
  for (const CaseResult& c : s.result.cases) {
    EXPECT_LT(c.checks.residual, 1e-9) << c.name;
    EXPECT_LT(c.checks.equilibrium, 1e-9) << c.name;
    EXPECT_LT(c.checks.energy, 1e-9) << c.name;
  }
  EXPECT_LT(s.result.reciprocity, 1e-9);
  return s;
}

void expect_same(double value, double expected) { EXPECT_NEAR(value, expected, 1e-9 * std::abs(expected) + 1e-15); }

// A pad that only pushes upwards, 1e4 N/m: pull is the compliance of the lifted node.
TEST(FrameLaws, AOneWaySupportPushesOnly) {
  const Solved s = solve(cantilever(R"(supports:
  A: clamped
  B: {uz: {law: one_sided, push: 0.1 mm/N, pull: 1e9 mm/N}}
loads: {down: {nodes: {B: {fz: -26 N}}}, up: {nodes: {B: {fz: 30 N}}}}
)"));
  expect_same(s.u("B", 0)(2), -26.0 / (k_tip + 1e4));
  expect_same(s.reaction("B", 0)(2), 20);
  expect_same(s.reaction("A", 0)(2), 6);
  EXPECT_NEAR(s.u("B", 1)(2), 30 / k_tip, 1e-10);
  EXPECT_NEAR(s.reaction("B", 1)(2), 0, 1e-7);
}

// The rigid pad is where push is absent.
TEST(FrameLaws, ARigidOneWaySupportTakesAllOfThePush) {
  const Solved s = solve(cantilever(R"(supports:
  A: clamped
  B: {uz: {law: one_sided, pull: 1e9 mm/N}}
loads: {down: {nodes: {B: {fz: -26 N}}}}
)"));
  EXPECT_NEAR(s.u("B")(2), 0, 1e-15);
  expect_same(s.reaction("B")(2), 26);
}

TEST(FrameLaws, AGapClosesAndThenHolds) {
  const Solved s = solve(cantilever(R"(supports: {A: clamped, B: {uz: {law: clearance, gap: 2 mm}}}
loads: {small: {nodes: {B: {fz: -3 N}}}, large: {nodes: {B: {fz: -30 N}}}, other side: {nodes: {B: {fz: 30 N}}}}
)"));
  expect_same(s.u("B", 0)(2), -3 / k_tip);
  EXPECT_EQ(s.reaction("B", 0)(2), 0);
  expect_same(s.u("B", 1)(2), -2e-3);
  expect_same(s.reaction("B", 1)(2), 30 - 6);
  expect_same(s.u("B", 2)(2), 2e-3);
  expect_same(s.reaction("B", 2)(2), -24);
}

// Play in series with rubber of 7000 N/m: (k_tip + 7000) u = P + 7000 g.
TEST(FrameLaws, LawsInSeriesAddTheirDeflections) {
  const Solved s = solve(cantilever(R"(supports:
  A: clamped
  B: {holds: [uz], uz: [{law: clearance, gap: 1 mm}, {law: linear, stiffness: 7 N/mm}]}
loads: {down: {nodes: {B: {fz: -30 N}}}}
)"));
  expect_same(s.u("B")(2), -(30 + 7) / (k_tip + 7000));
  expect_same(s.reaction("B")(2), 7000 * (37.0 / 10000 - 1e-3));
  EXPECT_EQ(s.result.cases[0].energies[0].first, "support B");
  expect_same(s.result.cases[0].energies[0].second, 7000 * std::pow(2.7e-3, 2) / 2);
}

// Friction of 6 N at 3000 N/m beside the free tip. It slips at 6 N, that is at 2 mm; the tip then takes the rest.
constexpr const char* friction = R"(supports:
  A: clamped
  B: {beside: {uz: {law: friction, force: 6 N, stiffness: 3 N/mm}}}
loads: {one: {nodes: {B: {fz: 6 N}}}, two: {nodes: {B: {fz: 15 N}}}, three: {factor: 0, nodes: {B: {fz: 6 N}}},
  four: {factor: -1, nodes: {B: {fz: 15 N}}}, five: {factor: 1, nodes: {B: {fz: 15 N}}}}
)";

TEST(FrameLaws, FrictionAtASupportMakesALoopInSequence) {
  FrameOptions in_sequence;
  in_sequence.in_sequence = true;
  for (const char* geometry : {"geometry: linear\n", "geometry: second-order\n"}) {
    const Solved s = solve(cantilever(friction) + geometry, in_sequence);
    expect_same(s.u("B", 0)(2), 6 / (2 * k_tip));
    expect_same(s.u("B", 1)(2), (15 - 6) / k_tip);  // slips by 3 mm − 2 mm
    expect_same(s.u("B", 2)(2), 0.5e-3);            // both springs about the slip of 1 mm
    expect_same(s.reaction("B", 2)(2), 1.5);
    expect_same(s.u("B", 3)(2), -(15 - 6) / k_tip);  // slips to −1 mm
    expect_same(s.u("B", 4)(2), (15 - 6) / k_tip);
    expect_same(s.result.cases[4].slips.at(0), 1e-3);
  }
}

TEST(FrameLaws, CasesBeginRelaxedUnlessInSequence) {
  const Solved s = solve(cantilever(friction));
  expect_same(s.u("B", 1)(2), (15 - 6) / k_tip);
  EXPECT_EQ(s.u("B", 2)(2), 0);
  expect_same(s.u("B", 3)(2), -(15 - 6) / k_tip);
}

// Slope-deflection, columns clamped at their feet, beam with springs k at both ends: under sway the beam resists each
// corner by S = (6EI/L)/(1 + 6EI/(kL)).
TEST(FrameLaws, APortalWithSemiRigidEnds) {
  const double EI = 210e9 * 1e-6, h = 3, L = 4, k = 2e5, H = 1000;
  const Solved s(parse_frame(R"(name: portal
plane: xz
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {stiff: {shape: given, A: 1e9 mm^2, Iy: 1e6 mm^4, Iz: 1e6 mm^4, J: 1e6 mm^4}}
nodes: {A: [0 m, 0 m, 0 m], B: [0 m, 0 m, 3 m], C: [4 m, 0 m, 3 m], D: [4 m, 0 m, 0 m]}
members:
  left: {from: A, to: B, section: stiff, material: steel}
  beam: {from: B, to: C, section: stiff, material: steel, start: {rz: {law: linear, stiffness: 2e5 Nm/rad}},
         end: {rz: {law: linear, stiffness: 2e5 Nm/rad}}}
  right: {from: D, to: C, section: stiff, material: steel}
supports: {A: clamped, D: clamped}
loads: {wind: {nodes: {B: {fx: 500 N}, C: {fx: 500 N}}}}
)",
                             "portal"));
  EXPECT_EQ(failed_check(s.result), "");
  const double S = 6 * EI / L / (1 + 6 * EI / (k * L));
  // (4EI/h + S) θ = 6EI/h² Δ, H = 2 (12EI/h³ Δ − 6EI/h² θ)
  const double theta = 6 * EI / (h * h) / (4 * EI / h + S);  // per Δ
  const double sway = H / (2 * (12 * EI / (h * h * h) - 6 * EI / (h * h) * theta));
  EXPECT_NEAR(s.u("B")(0), sway, 1e-7 * sway);
  EXPECT_NEAR(s.u("B")(4), theta * sway, 1e-7 * theta * sway);
  EXPECT_NEAR(std::abs(s.member("beam").start(5)), S * theta * sway, 1e-6 * S * theta * sway);
}

// A member's own y axis lies in the plane where its local y points up: the frame turns about z there. A law about y was
// read, and did nothing.
TEST(FrameLaws, AcrossThePlaneAreRefused) {
  const auto refusal = [](const std::string& low, const std::string& supports, const std::string& springs) {
    const std::string text =
        "name: f\nplane: xz\nmaterials: {steel: {E: 210 GPa, nu: 0.3}}\n"
        "sections: {rod: {shape: round, diameter: 20 mm}}\n"
        "nodes: {A: [0 m, 0 m, 0 m], B: [1 m, 0 m, 0 m], C: [1 m, 0 m, 1 m]}\nmembers:\n"
        "  low: {from: A, to: B, section: rod, material: steel" +
        low + "}\n  up: {from: B, to: C, section: rod, material: steel}\nsupports:\n  A: " + supports + "\n" + springs +
        "loads: {push: {nodes: {C: {fx: 1 N}}}}\n";
    return outcome_of<InputError>([&] { return parse_frame(text, "f.yaml"); }).why;
  };
  const std::string law = "{law: linear, stiffness: 5 kNm/rad}", push = "{law: linear, stiffness: 5 kN/mm}";
  EXPECT_EQ(refusal(", start: {rz: " + law + ", tx: " + push + "}", "{holds: pinned, ry: " + law + "}",
                    "springs: {s: {node: C, ux: 5 N/mm}}\n"),
            "");
  EXPECT_EQ(
      refusal(", start: {ry: " + law + "}", "clamped", ""),
      "f.yaml:7: members.low.start.ry: has no effect, because the plane xz of the frame holds ry here: the freedoms "
      "that it leaves are tx, ty, rz; write one of them, or take the law away");
  EXPECT_EQ(refusal(", start: {ry: " + law + ", rz: " + law + "}", "clamped", ""), "") << "as in space";
  EXPECT_TRUE(refusal(", end: {beside: {rx: " + law + "}}, release_to: [rx]", "clamped", "")
                  .starts_with("f.yaml:7: members.low.end.rx: has no effect"));
  EXPECT_TRUE(
      refusal("", "{holds: clamped, rz: " + law + "}", "").starts_with("f.yaml:10: supports.A.rz: has no effect"));
  EXPECT_TRUE(refusal("", "clamped", "springs: {s: {node: C, uy: 5 N/mm}}\n")
                  .starts_with("f.yaml:11: springs.s.uy: has no effect"));
}

TEST(FrameLaws, ACoupledSpringIsItsMatrix) {
  Matrix6 K = Matrix6::Zero();
  K.diagonal() << 3e5, 4e5, 5e5, 70, 80, 90;
  K(0, 1) = K(1, 0) = 1e5, K(0, 4) = K(4, 0) = -2e3, K(2, 3) = K(3, 2) = 1e3, K(4, 5) = K(5, 4) = 20;
  std::string rows;
  for (int i = 0; i < 6; ++i) {
    std::string row;
    for (int j = 0; j < 6; ++j) row += fmt::format("{}{}", j ? ", " : "", K(i, j));
    rows += fmt::format("{}[{}]", i ? ", " : "", row);
  }
  const std::string frame =
      "name: block\nnodes: {N: [0 mm, 0 mm, 0 mm], M: [0 mm, 300 mm, 0 mm]}\nsprings: {bed: "
      "{node: N, stiffness: {units: N-m, rows: [" +
      rows + "]}}, more: {node: M, to: N, stiffness: {units: N-m, rows: [" + rows +
      "]}}}\nloads: {push: {nodes: {N: {fx: 1 N, fz: -2 N, mx: 0.01 Nm, mz: 0.02 Nm}}}, far: "
      "{nodes: {M: {fx: 2e-4 N, fz: 1e-4 N, my: 1e-5 Nm}}}}\n";
  const Vector6 F = (Vector6() << 1, 0, -2, 0.01, 0, 0.02).finished();
  const Vector6 far = (Vector6() << 2e-4, 0, 1e-4, 0, 1e-5, 0).finished();
  const Matrix6 from_M = shift_twist(Vector3(0, 0.3, 0));
  for (const char* geometry : {"linear", "second-order", "finite"}) {
    const bool linear = geometry == std::string("linear");
    const double close = linear ? 1e-12 : 1e-4;  // rotations of up to 1e-3 do
    const Solved s(parse_frame(frame + "geometry: " + geometry + "\n", "test"));
    EXPECT_EQ(failed_check(s.result), "");
    const Vector6 u = K.inverse() * F, u_N = K.inverse() * from_M.transpose() * far;
    EXPECT_LT((s.u("N", 0) - u).norm(), 10 * close * u.norm()) << geometry;
    EXPECT_LT((s.result.cases[0].springs[0] + F).norm(), close * F.norm()) << geometry;
    EXPECT_LT(s.result.cases[0].springs[1].norm(), 1e-9) << geometry;
    EXPECT_LT((s.u("N", 1) - u_N).norm(), close * u_N.norm()) << geometry;
    EXPECT_LT((s.u("M", 1) - from_M * u_N - K.inverse() * far).norm(), close * u_N.norm()) << geometry;
    EXPECT_LT((s.result.cases[1].springs[1] + far).norm(), close * far.norm()) << geometry;
  }
}

// Three bars on one node, the middle one e too long: it pushes with k_m k_o/(k_m + k_o) e, the outer two (each with
// half of k_o in z) are pulled.
TEST(FrameLaws, AMisfitPrestressesATruss) {
  const std::string text = R"(name: three bars
plane: xz
materials: {steel: {E: 200 GPa, nu: 0.3}}
sections: {rod: {shape: given, A: 100 mm^2, Iy: 1000 mm^4, Iz: 1000 mm^4, J: 2000 mm^4}}
nodes: {L: [-1 m, 0 m, 1 m], M: [0 m, 0 m, 1 m], R: [1 m, 0 m, 1 m], P: [0 m, 0 m, 0 m]}
members:
  left: {from: L, to: P, section: rod, material: steel, truss: true}
  middle: {from: M, to: P, section: rod, material: steel, truss: true, misfit: 0.1 mm}
  right: {from: R, to: P, section: rod, material: steel, truss: true}
supports: {L: pinned, M: pinned, R: pinned}
loads: {weight: {nodes: {P: {fz: -1 kN}}}, none: {factor: 0, nodes: {P: {fz: -1 kN}}}}
)";
  const double EA = 2e7, k_m = EA, k_o = EA / std::sqrt(2), e = 1e-4;
  const double push = k_m * k_o / (k_m + k_o) * e, share = 1000 / (k_m + k_o);
  for (const char* geometry : {"linear", "second-order", "finite"}) {
    const Solved s = solve(text + "geometry: " + geometry + "\n");
    const double close = geometry == std::string("linear") ? 1e-9 : 1e-3;  // strains of 5e-5
    EXPECT_NEAR(s.u("P", 0)(2), -share, close * share) << geometry;
    EXPECT_NEAR(s.u("P", 1)(2), 0, 1e-15) << geometry;
    EXPECT_NEAR(s.member("middle", 1).start(0), -push, close * push) << geometry;
    EXPECT_NEAR(s.member("left", 1).start(0), push / std::sqrt(2), close * push) << geometry;
    EXPECT_NEAR(s.member("middle", 0).start(0), k_m * share - push, close * push) << geometry;
    EXPECT_NEAR(s.member("left", 0).start(0), (k_o * share + push) / std::sqrt(2), close * push) << geometry;
  }
}

// Along a line every geometry is the same: a bar, half of it heated or too long, between a wall and a gap.
TEST(FrameLaws, AllGeometriesAgreeAlongALine) {
  for (const char* geometry : {"linear", "second-order", "finite"}) {
    const Solved s = solve(cantilever(R"(supports:
  A: {holds: clamped, ux: {law: one_sided, push: 1e-4 mm/N, pull: 3e-4 mm/N}}
  B: {holds: [uy, uz, rx, ry, rz], ux: [{law: clearance, gap: 1 mm}, {law: hardening, stiffness: 2000 N/mm, reference: 1 mm}]}
loads: {push: {nodes: {B: {fx: 2 kN}}}, pull: {nodes: {B: {fx: -0.5 kN}}}}
)",
                                      ", misfit: 0.5 mm") +
                           "geometry: " + geometry + "\n");
    // The misfit alone closes nothing: the bar is 0.5 mm longer without force. Then δ = 0.5 mm + F/k is the end's
    // place.
    const double k_pull = 1 / (1 / k_along + 3e-7);
    double f = 0;  // of the hardening spring, by Newton: x beyond the gap
    double x = 1e-4;
    for (int i = 0; i < 60; ++i) {
      f = 2e6 * x * (1 + x * x / 1e-6);
      const double left = k_pull * (1e-3 + x - 0.5e-3) + f - 2000;
      x -= left / (k_pull + 2e6 * (1 + 3 * x * x / 1e-6));
    }
    expect_same(s.u("B", 0)(0), 0.5e-3 + x);
    EXPECT_NEAR(s.reaction("B", 0)(0), -f, 1e-9 * f) << geometry;
    EXPECT_NEAR(s.reaction("A", 0)(0), f - 2000, 1e-9 * 2000) << geometry;
    const double k_push = 1 / (1 / k_along + 1e-7);
    expect_same(s.u("B", 1)(0), -500 / k_push);
    EXPECT_NEAR(s.member("beam", 1).start(0), -500, 1e-6) << geometry;
  }
}

// Tension pulls at both ends of a member: each opens by its own compliance, and a gap at the end by its travel.
TEST(FrameLaws, EndsOpenUnderTension) {
  const std::string ends =
      ", start: {tx: {law: one_sided, pull: 1e-3 mm/N, push: 2e-3 mm/N}}, end: {tx: [{law: "
      "one_sided, pull: 3e-3 mm/N, push: 5e-3 mm/N}, {law: clearance, gap: 1 mm}]}";
  for (const char* geometry : {"linear", "second-order", "finite"}) {
    const Solved s = solve(cantilever("supports: {A: clamped, B: [uy, uz, rx, ry, rz]}\nloads: {pull: {nodes: {B: {fx: "
                                      "100 N}}}, push: {nodes: {B: {fx: -100 N}}}}\n",
                                      ends) +
                           "geometry: " + geometry + "\n");
    EXPECT_NEAR(s.u("B", 0)(0), 100 * (1e-6 + 1e-6 + 3e-6) + 1e-3, 1e-12) << geometry;
    EXPECT_NEAR(s.u("B", 1)(0), -100 * (1e-6 + 2e-6 + 5e-6) - 1e-3, 1e-12) << geometry;
    EXPECT_NEAR(s.member("beam", 0).start(0), 100, 1e-7) << geometry;
  }
}

// A table that remembers beside a bar of 1e6 N/m: 50 N and 150 N at 150 um, back 30 N and 130 N, none and 40 N, and by
// push as by pull.
TEST(FrameLaws, ATableLoadsAndUnloadsByItsBranches) {
  FrameOptions in_sequence;
  in_sequence.in_sequence = true;
  for (const char* geometry : {"linear", "second-order", "finite"}) {
    const Solved s = solve(cantilever(R"(supports:
  A: clamped
  B: {ux: {law: table, points: [[0 N, 0 um], [10 N, 10 um], [30 N, 70 um], [50 N, 150 um]],
      unloading: [[50 N, 150 um], [30 N, 130 um], [10 N, 90 um], [0 N, 40 um]]}}
loads: {a: {nodes: {B: {fx: 100 N}}}, b: {nodes: {B: {fx: 200 N}}}, c: {nodes: {B: {fx: 160 N}}}, d: {nodes: {B: {fx: 40 N}}}, e: {nodes: {B: {fx: -200 N}}}, f: {nodes: {B: {fx: -40 N}}}, g: {nodes: {B: {fx: 200 N}}}}
)") + "geometry: " + geometry + "\n",
                           in_sequence);
    const double by_hand[] = {70, 150, 130, 40, -150, -40, 150};
    for (std::size_t c = 0; c < std::size(by_hand); ++c) {
      EXPECT_NEAR(s.u("B", c)(0), by_hand[c] * 1e-6, 1e-9 * 150e-6) << geometry << " " << c;
      EXPECT_NEAR(s.reaction("A", c)(0), -by_hand[c] * 1e-6 * k_along, 1e-9 * 150) << geometry << " " << c;
    }
  }
}

// Two frictions and a linear law side by side at one end: they share its elongation.
TEST(FrameLaws, LawsBesideShareTheElongation) {
  const Solved s =
      solve(cantilever("supports: {A: clamped, B: [uy, uz, rx, ry, rz]}\nloads: {pull: {nodes: {B: {fx: 100 N}}}}\n",
                       ", end: {tx: {law: linear, stiffness: 100 N/mm}, beside: {tx: [{law: friction, force: 10 N, "
                       "stiffness: 1000 N/mm}, "
                       "{law: friction, force: 50 N, stiffness: 100 N/mm}]}}"));
  // 100 = 1e5 x + 10 + 1e5 x: the first has slipped, the second not.
  expect_same(s.u("B")(0), 90.0 / 2e5 + 100 / k_along);
  expect_same(s.member("beam").end(0), 100);
}

TEST(FrameLaws, AFactorIsOnAllStiffnessesOfAMemberAndOnAllOfACase) {
  const std::string rest =
      "supports: {A: clamped}\nloads: {case: {factor: 3, nodes: {B: {fx: 1 N, fz: 1 N}}, members: "
      "{beam: {qy: 2 N/m}}, temperature: {beam: 10 K}, displacements: {A: {ux: 1 mm}}}}\n";
  const Solved s = solve(cantilever(rest, ", factor: 0.5"));
  expect_same(s.u("B")(0), 3 * (1 / (0.5 * k_along) + 1e-4 + 1e-3));
  expect_same(s.u("B")(1), 3 * 2 / (8 * 0.5 * k_tip / 3));
  expect_same(s.u("B")(2), 3 / (0.5 * k_tip));
}

// A stiff bar on a rotational spring turns until k θ = P L cos θ; with k = P L to θ = 0.739085. Play adds to the angle.
// The bar bends by 1e-6 of its length; it is 1e7 times stiffer than the spring, which costs as many digits.
TEST(FrameLaws, AnElasticSupportTurnsAtFiniteAngles) {
  const std::string bar = R"(name: bar
geometry: finite
load_steps: 5
materials: {stiff: {E: 2e4 GPa, nu: 0.25}}
sections: {deep: {shape: given, A: 100 mm^2, Iy: 1e6 mm^4, Iz: 1e6 mm^4, J: 1e6 mm^4}}
nodes: {A: [0 m, 0 m, 0 m], B: [1 m, 0 m, 0 m]}
members: {beam: {from: A, to: B, section: deep, material: stiff}}
loads: {tip: {nodes: {B: {fz: -100 N}}}}
)";
  const Solved s(parse_frame(bar + "supports: {A: {holds: clamped, ry: {law: linear, stiffness: 100 Nm/rad}}}\n", "s"));
  EXPECT_EQ(failed_check(s.result), "");
  EXPECT_NEAR(s.u("A")(4), 0.7390851332, 2e-6);
  EXPECT_NEAR(s.u("B")(2), -std::sin(0.7390851332), 2e-6);
  EXPECT_NEAR(s.reaction("A")(4), -100 * 0.7390851332, 3e-4);
  EXPECT_NEAR(s.reaction("A")(2), 100, 1e-4);
  const Solved loose(parse_frame(bar + "supports: {A: {holds: clamped, ry: [{law: linear, stiffness: 100 Nm/rad}, "
                                       "{law: clearance, gap: 0.1 rad}]}}\n",
                                 "loose"));
  EXPECT_EQ(failed_check(loose.result), "");
  double angle = 0.7;
  for (int i = 0; i < 100; ++i) angle -= (angle - 0.1 - std::cos(angle)) / (1 + std::sin(angle));
  EXPECT_NEAR(loose.u("A")(4), angle, 2e-6);
}

TEST(FrameLaws, ContactNeedsItsMaterial) {
  const Solved s = solve(cantilever(
      "supports: {A: clamped, B: {uz: {law: hertz_point, material: steel, radius: 5 mm}}}\nloads: {down: {nodes: {B: "
      "{fz: -10 N}}}}\n"));
  const double u = -s.u("B")(2), E_star = 1e9 / (2 * (1 - 0.0625));
  expect_same(k_tip * u + 4.0 / 3 * E_star * std::sqrt(0.01) * std::pow(u, 1.5), 10);
}

}  // namespace
}  // namespace deflect::frame
