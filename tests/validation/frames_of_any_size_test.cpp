// What is hidden in a footbridge is found as it is on a bench: friction of kN, a support that lets go, a restraint.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "msa/frame/file/frame_file.h"
#include "tests/support/effects.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/diagnosis/interval.h"
#include "validation/effects/place_effects.h"
#include "validation/subject/simulate_frame.h"
#include "validation/subject/subject.h"

namespace deflect {
namespace {

using diagnosis::Diagnosis;
using diagnosis::Verdict;
using subject::Subject;

/// Two spans of 10 m on three bearings, of which the last one gives.
const Subject& footbridge() {
  static const Subject s = frame::parse_frame(R"(
name: footbridge
plane: xz
materials: {aluminium: {E: 69 GPa, nu: 0.33}}
sections: {box: {shape: given, A: 12000 mm^2, Iy: 9e8 mm^4, Iz: 9e8 mm^4, J: 1e9 mm^4}}
nodes: {A: [0 m, 0 m, 0 m], B: [5 m, 0 m, 0.2 m], C: [10 m, 0 m, 0 m], D: [15 m, 0 m, 0.2 m], E: [20 m, 0 m, 0 m]}
members:
  AB: {from: A, to: B, section: box, material: aluminium, y_axis: [0, 1, 0]}
  BC: {from: B, to: C, section: box, material: aluminium, y_axis: [0, 1, 0]}
  CD: {from: C, to: D, section: box, material: aluminium, y_axis: [0, 1, 0]}
  DE: {from: D, to: E, section: box, material: aluminium, y_axis: [0, 1, 0]}
supports: {A: [ux, uz], C: [uz], E: {uz: {law: linear, stiffness: 60 kN/mm}}}
loads:
  first: {nodes: {B: {fz: -40 kN}}}
  last: {nodes: {D: {fz: -40 kN}}}
  pull: {nodes: {E: {fx: 30 kN}}}
sensors:
  z_B: {node: B, direction: uz, sigma: 0.03 mm}
  z_D: {node: D, direction: uz, sigma: 0.03 mm}
  x_E: {node: E, direction: ux, sigma: 0.02 mm}
  turn: {node: A, direction: ry, sigma: 0.01 mrad}
  pad: {support: E, reaction: fz, sigma: 100 N}
tolerances: {modulus: 1 %, load: 0.2 %, member.factor: 1 %}
)",
                                              "footbridge.yaml");
  return s;
}

const std::vector<effects::Effect>& laws() {
  static const std::vector<effects::Effect> all = effects::place_effects(footbridge(), {});
  return all;
}

Diagnosis diagnosed_with(const std::string& name, std::initializer_list<double> values, std::uint64_t seed = 1) {
  const auto law = std::find_if(laws().begin(), laws().end(), [&](const auto& e) { return e.name == name; });
  if (law == laws().end()) throw std::logic_error("no effect " + name);
  const Subject truth = effects::with_effect(footbridge(), {{&*law, {}}, test::values(values)});
  prediction::SimulationOptions drawn;
  drawn.seed = seed;
  const measurement::Measurements data =
      subject::simulate_frame(*truth.frame(), subject::frame_campaign("cycle", *footbridge().frame(), 1), drawn);
  diagnosis::DiagnosisOptions options;
  options.bootstrap_sets = 99;
  return diagnosis::diagnose(footbridge(), data, laws(), options);
}

bool is_tied(const Diagnosis& d, const std::string& name) {
  return std::any_of(d.indistinguishable.begin(), d.indistinguishable.end(),
                     [&](const auto& group) { return std::find(group.begin(), group.end(), name) != group.end(); });
}

// Shapes of a friction of some newtons say little of one of kN.
TEST(FramesOfAnySize, ABearingThatRubsWithKilonewtonsIsNamed) {
  const Diagnosis d = diagnosed_with("friction@support.E.ux", {2000, 5000});
  ASSERT_FALSE(d.missing.empty());
  EXPECT_NE(d.verdict, Verdict::unknown_effect);
  EXPECT_EQ(d.missing.front().effect->name, "friction@support.E.ux");
  const auto [low, high] = diagnosis::interval95(d.missing, d.fit, 0);
  EXPECT_LT(low, 2000);
  EXPECT_GT(high, 2000);
  EXPECT_LT(high, 1.5 * low);
}

// It yields without end to one sense.
TEST(FramesOfAnySize, ABearingThatLiftsOffIsNamed) {
  const Diagnosis d = diagnosed_with("pull@support.E.uz", {10});
  ASSERT_FALSE(d.missing.empty());
  EXPECT_NE(d.verdict, Verdict::unknown_effect);
  EXPECT_EQ(d.missing.front().effect->name, "pull@support.E.uz");
}

// A friction that never slips is a restraint, and the restraint is named alone.
TEST(FramesOfAnySize, ARestraintIsNoFrictionThatNeverSlips) {
  const Diagnosis d = diagnosed_with("restraint@support.E.ux", {5000}, 4);
  ASSERT_FALSE(d.missing.empty());
  EXPECT_EQ(d.missing.front().effect->name, "restraint@support.E.ux");
  EXPECT_FALSE(is_tied(d, "friction@support.E.ux"));
}

// Of a friction that slips at the turns of the largest load alone chance has a word: both stand side by side.
TEST(FramesOfAnySize, ARestraintStandsBesideAFrictionThatHardlySlips) {
  const Diagnosis d = diagnosed_with("friction@support.E.ux", {8000, 5000});
  ASSERT_FALSE(d.missing.empty());
  EXPECT_EQ(d.verdict, Verdict::ambiguous);
  EXPECT_TRUE(is_tied(d, "restraint@support.E.ux"));
  EXPECT_TRUE(is_tied(d, "friction@support.E.ux"));
}

}  // namespace
}  // namespace deflect
