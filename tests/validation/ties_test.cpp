// What these data cannot tell apart is told together, and the table of candidates agrees with the verdict.
#include <gtest/gtest.h>

#include <algorithm>

#include "msa/frame/file/frame_file.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "tests/support/effects_everywhere.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"
#include "validation/subject/simulate_frame.h"

namespace deflect {
namespace {

using namespace diagnosis;

// One post stands on a hinge. Whether that hinge shifts, or the joint with the beam turns, on either side of it, the
// readings of two other nodes are the same.
constexpr const char* hinged_portal = R"(
name: hinged portal
plane: xz
materials: {steel: {E: 210 GPa, nu: 0.3}, timber: {E: 11 GPa, nu: 0.3}}
sections: {post: {shape: box, width_y: 100 mm, height_z: 100 mm, wall: 8 mm}, beam: {shape: rectangle, width_y: 80 mm, height_z: 160 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [0 m, 0 m, 2.5 m], C: [3 m, 0 m, 2.5 m], D: [3 m, 0 m, 0 m], M: [1.5 m, 0 m, 2.5 m]}
members:
  left: {from: A, to: B, section: post, material: steel}
  right: {from: D, to: C, section: post, material: steel}
  beam1: {from: B, to: M, section: beam, material: timber}
  beam2: {from: M, to: C, section: beam, material: timber}
supports: {A: clamped, D: pinned}
loads:
  side: {nodes: {B: {fx: 4 kN}}}
  middle: {nodes: {M: {fz: -3 kN}}}
sensors:
  top: {node: B, direction: ux, sigma: 0.02 mm}
  mid: {node: M, direction: uz, sigma: 0.02 mm}
tolerances: {modulus: 1 %, load: 0.3 %}
)";

// Where the spring is soft, each of the three explains far more than its signature, that of a small size, promises.
TEST(Ties, HoldWhatDoesTheSameAtAnySize) {
  const subject::Subject s = frame::parse_frame(hinged_portal, "portal.yaml");
  const std::vector<effects::Effect> all = test::effects_everywhere(s);
  const auto hidden =
      std::find_if(all.begin(), all.end(), [](const effects::Effect& e) { return e.name == "linear@right.end.rz"; });
  ASSERT_NE(hidden, all.end());
  for (const double stiffness : {1e7, 1e8}) {  // Nmm/rad
    const subject::Subject truth =
        effects::with_effect(s, effects::EffectInstance{{&*hidden, {}}, VectorX::Constant(1, stiffness)});
    prediction::SimulationOptions o;
    o.seed = 2;
    const measurement::Measurements data =
        subject::simulate_frame(*truth.frame(), subject::frame_campaign("cycle", *s.frame(), 2), o);
    const Diagnosis d = diagnose(s, data, all, {{}, 199});
    EXPECT_EQ(d.verdict, Verdict::ambiguous) << stiffness;
    ASSERT_EQ(d.indistinguishable.size(), 1u) << stiffness;
    const std::vector<std::string>& tied = d.indistinguishable.front();
    for (const char* each : {"linear@right.end.rz", "linear@beam2.end.rz", "linear@support.D.ux"})
      EXPECT_NE(std::find(tied.begin(), tied.end(), each), tied.end()) << each << " at " << stiffness;
    EXPECT_EQ(tied.front(), name_of(d.missing.front())) << "what was found comes first";
  }
}

// A search that came to an effect by way of another has a fit that the first step may not have: it takes its place.
TEST(Candidates, ALaterFitTakesThePlaceOfNone) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  const std::vector<effects::Effect> effects = {test::effect("guide_root_compliance"), test::effect("load_gain")};
  const Mechanism truth = effects::with_effect(m, effects[0], test::values({5e6}));
  prediction::SimulationOptions exact;
  exact.tolerances = 0;
  const measurement::Measurements data = prediction::simulate(truth, prediction::campaign("paper", m, 50, 1), exact);
  const subject::Subject s(m);
  const Observations o(s, data, {});
  const std::vector<Signature> all = signatures(o, effects, 1);
  const Candidates candidates(all, 1);
  const Fit null = fit_of_all(o, {}, VectorX(0));
  const std::vector<Candidate> first = candidates.beside(o, {}, null, -1e6);
  const auto at = std::find_if(first.begin(), first.end(),
                               [](const Candidate& c) { return c.added().effect->name == "guide_root_compliance"; });
  ASSERT_TRUE(at != first.end() && at->fit.found);
  std::vector<Candidate> without = first;
  Candidate& lost = without[static_cast<std::size_t>(at - first.begin())];
  lost.fit = {};
  lost.gain = 0;
  lost.log_odds = -5;
  const std::vector<Candidate> again = candidates.fitted_again(o, null, without, {{at->added(), 1.1 * at->fit.values}});
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_NEAR(again[i].log_odds, first[i].log_odds, 1e-3) << i;  // both fits end within 1e-3 of the least χ²
    EXPECT_NEAR(again[i].class_log_odds, first[i].class_log_odds, 1e-3) << i;
    EXPECT_NEAR(again[i].chi2_per_dof, first[i].chi2_per_dof, 1e-3) << i;
  }
}

}  // namespace
}  // namespace deflect
