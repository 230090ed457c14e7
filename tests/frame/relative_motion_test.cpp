// Which parts of a frame are so stiff that they get coordinates of their own.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "msa/frame/file/frame_build.h"
#include "msa/frame/structure/relative.h"
#include "tests/support/frames.h"

namespace deflect::frame {
namespace {

FrameDescription frame_of(const std::string& rest) {
  return parse_frame(
      "name: f\nplane: xz\nmaterials: {steel: {E: 210 GPa, nu: 0.3}}\nsections: {rod: {shape: round, diameter: 20 "
      "mm}}\n" +
          rest,
      "frame.yaml");
}

bool wants(const FrameDescription& f) { return wants_relative_motion(build_frame(f).model); }

// A brace that is all but missing in a portal that stands without it.
TEST(RelativeMotion, AMemberThatIsAllButMissingMakesNoOtherStiff) {
  const auto portal = [](const std::string& factor) {
    return frame_of(
        "nodes: {A: [0 m, 0 m, 0 m], B: [0 m, 0 m, 1 m], C: [1 m, 0 m, 1 m], D: [1 m, 0 m, 0 m]}\n"
        "members: {left: {from: A, to: B, section: rod, material: steel}, beam: {from: B, to: C, section: rod, "
        "material: steel}, right: {from: D, to: C, section: rod, material: steel}, brace: {from: A, to: C, section: "
        "rod, material: steel, factor: " +
        factor + "}}\nsupports: {A: clamped, D: clamped}\nloads: {side: {nodes: {B: {fx: 100 N}}}}\n");
  };
  EXPECT_FALSE(wants(portal("1")));
  EXPECT_FALSE(wants(portal("1e-6")));
  EXPECT_TRUE(wants(portal("1e-12")));
  // Along x the brace holds with 1e-6 EA/2L = 23 N/m, the portal with 0.7 · 24 EI/h³ = 28 kN/m: 0.8e-3 of it.
  const test::Solved with(portal("1e-6")), nearly_without(portal("1e-7"));
  EXPECT_EQ(failed_check(with.result), "");
  EXPECT_NEAR(with.u("B")(0), nearly_without.u("B")(0), 2e-3 * std::abs(with.u("B")(0)));
}

// In a line the soft one carries all: what hangs on it moves by far more than it deforms.
TEST(RelativeMotion, WhatHangsOnASoftMemberIsStiff) {
  EXPECT_TRUE(
      wants(frame_of("nodes: {A: [0 m, 0 m, 0 m], B: [1 m, 0 m, 0 m], C: [2 m, 0 m, 0 m]}\n"
                     "members: {soft: {from: A, to: B, section: rod, material: steel, factor: 1e-6}, stiff: {from: B, "
                     "to: C, section: rod, material: steel}}\n"
                     "supports: {A: clamped}\nloads: {down: {nodes: {C: {fz: -1 N}}}}\n")));
}

// Two bars at a right angle carry a load that lies along neither of them. The soft one lies beside a stiffer path to
// the ground; without it nothing stands, so that it carries what statics says, N = F cos 45°, and lengthens by
// N L/(f E A), as the other one by N L/(E A).
TEST(RelativeMotion, ASoftBarThatIsNeededKeepsItsDigits) {
  for (const double factor : {1.0, 1e-3, 1e-6}) {
    const test::Solved s(
        frame_of("nodes: {A: [0 m, 0 m, 0 m], B: [2 m, 0 m, 0 m], C: [1 m, 0 m, 1 m]}\n"
                 "members: {one: {from: A, to: C, section: rod, material: steel, truss: true}, two: {from: B, to: C, "
                 "section: rod, material: steel, truss: true, factor: " +
                 std::to_string(factor) + "}}\nsupports: {A: pinned, B: pinned}\n" +
                 "loads: {up: {nodes: {C: {fz: 100 N}}}}\n"));
    EXPECT_EQ(failed_check(s.result), "");
    const double A = pi / 4 * 0.02 * 0.02, N = 100 * std::sqrt(0.5), L = std::sqrt(2);
    const double one = N * L / (210e9 * A), two = one / factor;
    const double tolerance = 1e-9 * (one + two);
    EXPECT_NEAR(s.u("C")(0), (one - two) * std::sqrt(0.5), tolerance) << factor;
    EXPECT_NEAR(s.u("C")(2), (one + two) * std::sqrt(0.5), tolerance) << factor;
    EXPECT_NEAR(s.member("one").start(0), N, 1e-9 * N) << factor;
  }
}

}  // namespace
}  // namespace deflect::frame
