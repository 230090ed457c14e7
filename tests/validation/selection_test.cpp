// The odds of candidates by their definition, and when one more effect is taken.
#include "validation/diagnosis/selection.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "tests/support/springs_apart.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"
#include "validation/statistics/evidence.h"

namespace deflect {
namespace {

using namespace diagnosis;
using namespace effects;

/// The change along axis i of a residual of six numbers.
Signature along(const std::string& effect, Eigen::Index i, bool shaped = false) {
  Signature s;
  s.effect = {&test::effect(effect), {}};
  s.basis = MatrixX::Zero(6, 1);
  s.basis(i, 0) = 1;
  s.start = VectorX::Unit(s.basis.cols(), 0);
  s.lambda = 1;
  s.shaped = shaped;
  return s;
}

// Something is missing with probability 0.8, and is not in the catalogue with 0.1 of that; the entries share the rest
// alike. Of the shapes of a shaped effect one in three, or so, does what the best does.
TEST(Candidates, OddsArePriorTimesEvidence) {
  const std::vector<Signature> all = {along("guide_root_compliance", 0), along("modulus", 1),
                                      along("joint_clearance", 2, true), along("sensor_drift", 3)};
  const Candidates candidates(all, 1);
  const double prior = 0.8 * (1 - 0.1) / 4;
  for (const double gain : {0.0, 7.0, 40.0})
    for (const Signature& s : all)
      EXPECT_NEAR(candidates.class_log_odds_of(s.effect, gain),
                  std::log(prior / (1 - 0.8)) + statistics::log_evidence(gain, 1, false) - (s.shaped ? std::log(3) : 0),
                  1e-12)
          << s.effect.effect->name << " " << gain;
}

// Two entries that do the same have the prior of one together.
TEST(Candidates, WhatTheDataCannotTellApartSharesAPrior) {
  const std::vector<Signature> all = {along("guide_root_compliance", 0), along("modulus", 0), along("sensor_drift", 3)};
  const Candidates candidates(all, 1);
  const double gain = 12, evidence = statistics::log_evidence(gain, 1, false);
  for (const Signature& s : all)
    EXPECT_NEAR(candidates.class_log_odds_of(s.effect, gain), std::log(0.8 * 0.9 / 2 / 0.2) + evidence, 1e-12);
}

/// The size of the sensor's drift, and what came of it.
struct Step {
  double odds = 0;  ///< ln, of a second effect beside the first
  std::size_t effects = 0;
};

Step with_drift(double metres) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  const std::vector<Effect> effects = {test::effect("guide_root_compliance"), test::effect("sensor_drift")};
  Mechanism truth = with_effect(m, effects[0], test::values({5e6}));
  truth.sensor.drift = Vector3(metres, 0, 0);
  prediction::SimulationOptions exact;
  exact.tolerances = 0;
  const measurement::Measurements data = prediction::simulate(truth, prediction::campaign("paper", m, 50, 1), exact);
  const Observations o(subject::Subject(m), data, {});
  const std::vector<Signature> all = signatures(o, effects, 1);
  const Candidates candidates(all, 1);
  const Fit null = fit_of_all(o, {}, VectorX(0));
  const std::vector<Candidate> first = candidates.beside(o, {}, null, -1e6);
  const auto best = std::max_element(first.begin(), first.end(), [](const Candidate& a, const Candidate& b) {
    return a.class_log_odds < b.class_log_odds;
  });
  Step out;
  const Observations granted = o.granted(subject_with(o, best->hypothesis, best->fit.values));
  const Fit alone = fit_of_all(granted, best->hypothesis, best->fit.values);
  out.odds = -1e9;
  for (const Candidate& c : candidates.beside(granted, best->hypothesis, alone, -1e6))
    out.odds = std::max(out.odds, c.class_log_odds);
  out.effects = select(o, candidates, first).effects.size();
  return out;
}

/// A drift for which ln of the odds lies within 0.5 of what is wanted, by bisection between 0.1 µm and 1 mm.
Step with_odds_about(double wanted) {
  double low = 1e-7, high = 1e-3;
  Step s;
  for (int i = 0; i < 30; ++i) {
    const double middle = std::sqrt(low * high);
    s = with_drift(middle);
    if (std::abs(s.odds - wanted) < 0.5) return s;
    (s.odds < wanted ? low : high) = middle;
  }
  ADD_FAILURE() << "no drift has ln of the odds " << wanted << "; the last, " << s.odds;
  return s;
}

// The odds are those of 4 to 1 for something missing; of 1 to 3 for something more they are even where these are 12.
TEST(Selection, TakesAFurtherEffectWhereItIsLikelierThanNot) {
  EXPECT_EQ(with_odds_about(std::log(12) - 0.6).effects, 1u);
  EXPECT_EQ(with_odds_about(std::log(12) + 0.6).effects, 2u);
}

/// Of the size at which it changes the readings by λ: a compliance is in proportion to it.
double stiffness_for(const Signature& s, double lambda) {
  return s.effect.effect->parameters.front().start * s.lambda / lambda;
}

/// An effect of one parameter, its size, that yields at the places of several others at once: at size 1 as each of them
/// would with its stiffness.
Effect all_at_once(const std::vector<std::pair<const Effect*, double>>& parts) {
  Effect out;
  out.name = out.title = "all_at_once";
  out.scope = Scope::machine;
  EffectParameter size;
  size.name = "size";
  size.start = 1;
  size.high = 100;
  size.vanishes = 0;
  out.parameters = {size};
  out.edits_at = [parts](const VectorX& values) {
    std::vector<EffectEdit> edits;
    for (const auto& [effect, stiffness] : parts)
      for (EffectEdit edit : effect->edits) {
        edit.value = fmt::format("{{law: linear, stiffness: {:.17g} {}}}", stiffness / values(0),
                                 effect->parameters.front().unit);
        edits.push_back(edit);
      }
    return edits;
  };
  out.edits = out.edits_at(VectorX::Ones(1));
  return out;
}

// Two effects of λ = 20 each, and a third that resembles their sum: it takes both half-way and yields at one place
// more. Alone it explains most, and beside it each of the two would have to act backwards in part; the two together are
// right.
TEST(Selection, TwoEffectsAreFoundThatAThirdResembles) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  const Effect &root = test::effect("guide_root_compliance"), &base = test::effect("base_tilt"),
               &actuator = test::effect("actuator_compliance");
  const measurement::Measurements plan = prediction::campaign("rich", m, 50, 1);
  prediction::SimulationOptions exact;
  exact.tolerances = 0;
  const measurement::Measurements healthy = prediction::simulate(m, plan, exact);
  const Observations unloaded(subject::Subject(m), healthy, {});
  const std::vector<Effect> three = {root, base, actuator};
  const std::vector<Signature> alone = signatures(unloaded, three, 1);
  ASSERT_EQ(alone.size(), 3u);
  const double of_root = stiffness_for(alone[0], 20), of_base = stiffness_for(alone[1], 20);
  const Effect third = all_at_once({{&root, of_root}, {&base, of_base}, {&actuator, stiffness_for(alone[2], 15)}});
  const std::vector<Effect> effects = {root, base, third};

  Mechanism truth = with_effect(m, root, test::values({of_root}));
  truth = with_effect(truth, base, test::values({of_base}));
  const measurement::Measurements data = prediction::simulate(truth, plan, exact);
  const Observations o(subject::Subject(m), data, {});
  const std::vector<Signature> all = signatures(o, effects, 1);
  const Candidates candidates(all, 1);
  const std::vector<Candidate> first = candidates.beside(o, {}, fit_of_all(o, {}, VectorX(0)), -1e6);
  const auto best = std::max_element(first.begin(), first.end(),
                                     [](const Candidate& a, const Candidate& b) { return a.log_odds < b.log_odds; });
  ASSERT_EQ(best->added().effect->name, "all_at_once");
  const Selection found = select(o, candidates, first);
  std::vector<std::string> names;
  for (const PlacedEffect& e : found.effects) names.push_back(e.effect->name);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"base_tilt", "guide_root_compliance"}));
}

// A law at a place that does the same as an entry and is ten times as rare before any reading is not told beside it;
// another entry that does nearly the same is. By the definition they have 0.61, 0.33 and 0.06.
TEST(Selection, AnEntryStandsForTheLawThatDoesTheSame) {
  const auto axis = [](Eigen::Index i) { return VectorX::Unit(6, i); };
  std::vector<Effect> known = {
      test::springs_apart::along("entry", axis(0)),
      test::springs_apart::along("nearly", std::cos(0.06) * axis(0) + std::sin(0.06) * axis(1)),
      test::springs_apart::along("law", axis(0))};
  for (int i = 2; i < 5; ++i)
    for (int k = 0; k < 3; ++k)
      known.push_back(test::springs_apart::along(fmt::format("law_{}{}", i, k), axis(i) + k * axis(5)));
  for (std::size_t i = 2; i < known.size(); ++i) known[i].place.emplace().path = "part";
  const test::springs_apart::Seen s = test::springs_apart::seen(20 * axis(0));
  const std::vector<Signature> all = signatures(s.observations, known, 1);
  ASSERT_EQ(all.size(), 12u);
  ASSERT_NEAR(weights_of(all)[2], 0.1, 1e-12);
  const Candidates candidates(all, 1);
  const Fit null = fit_of_all(s.observations, {}, VectorX(0));
  const Selection found = select(s.observations, candidates, candidates.beside(s.observations, {}, null, -1e6));
  ASSERT_EQ(found.effects.size(), 1u);
  ASSERT_EQ(found.ties.size(), 1u);
  EXPECT_EQ(found.ties[0].names, (std::vector<std::string>{"entry", "nearly"}));
  ASSERT_EQ(found.ties[0].rivals.size(), 2u);
  EXPECT_NEAR(found.ties[0].rivals[0].probability, 0.61, 0.02);
}

// Two laws that begin alike and are as likely before any reading. What the second one bends, 1.9 standard deviations
// here, makes it the less likely one, 1 : 6; it is no other name of the first.
TEST(Selection, ALawThatIsLessLikelyByTheReadingsStaysInATie) {
  const auto bent = [](const VectorX& values) {
    return VectorX(values(0) * VectorX::Unit(6, 0) + 0.0047 * values(0) * values(0) * VectorX::Unit(6, 1));
  };
  const std::vector<Effect> known = {
      test::springs_apart::along("line", VectorX::Unit(6, 0)),
      test::springs_apart::effect("bent", {test::springs_apart::parameter("size", 1, -1000, 1000, 0.0)}, bent)};
  const test::springs_apart::Seen s = test::springs_apart::seen(20 * VectorX::Unit(6, 0));
  const std::vector<Signature> all = signatures(s.observations, known, 1);
  const Candidates candidates(all, 1);
  const Fit null = fit_of_all(s.observations, {}, VectorX(0));
  const std::vector<Candidate> first = candidates.beside(s.observations, {}, null, -1e6);
  ASSERT_EQ(first.size(), 2u);
  ASSERT_EQ(first[0].class_log_odds, first[1].class_log_odds);
  ASSERT_GT(first[0].log_odds, first[1].log_odds + 1.5);
  const Selection found = select(s.observations, candidates, first);
  ASSERT_EQ(found.ties.size(), 1u);
  EXPECT_EQ(found.ties[0].names, (std::vector<std::string>{"line", "bent"}));
}

}  // namespace
}  // namespace deflect
