// Where a search of the diagnosis begins and ends, on effects made by hand whose right values follow from what they do.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/support/effects.h"
#include "tests/support/springs_apart.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/diagnosis/fit_problem.h"
#include "validation/diagnosis/left_over.h"
#include "validation/diagnosis/selection.h"

namespace deflect {
namespace {

using namespace diagnosis;
using namespace effects;
using test::springs_apart::along;
using test::springs_apart::effect;
using test::springs_apart::parameter;
using test::springs_apart::seen;
using test::springs_apart::Seen;

VectorX axis(Eigen::Index size, Eigen::Index i) { return VectorX::Unit(size, i); }

TEST(SearchLimits, ChangesAreInStandardDeviations) {
  const Seen s = seen(3 * axis(4, 1) - 4 * axis(4, 2));
  EXPECT_NEAR(s.observations.null_residual().norm(), 5, 1e-3);
  const Effect e = along("second", axis(4, 1));
  const Fit f = fit(s.observations, {{&e, {}}});
  ASSERT_TRUE(f.found);
  EXPECT_NEAR(f.values(0), 3, 1e-3);
  EXPECT_NEAR(f.chi2, 16, 1e-2);
}

// A factor from a twentieth to ten is searched from four sizes about 1 and far from it, and found.
TEST(SearchLimits, AFactorOfFewStartsIsFound) {
  EffectParameter factor = parameter("factor", 0.5, 0.05, 10, 1.0);
  factor.log = true;
  const Effect e =
      effect("factor", {factor}, [](const VectorX& values) { return VectorX(20 * std::log(values(0)) * axis(4, 0)); });
  for (const double truth : {0.2, 0.9, 3.0}) {
    const Seen s = seen(20 * std::log(truth) * axis(4, 0));
    const Fit f = fit(s.observations, {{&e, {}}});
    ASSERT_TRUE(f.found) << f.why;
    EXPECT_NEAR(f.values(0), truth, 1e-3 * truth);
  }
}

// A part of stiffness f beside one of ½: its deflection 1/(½ + f) hardly grows below f = 0.01. A search from f = 50,
// which the derivative there sends beyond the other end of the range, where nothing leads back, is begun again.
TEST(SearchLimits, ASearchThatJumpedToTheEndIsBegunAgain) {
  EffectParameter factor = parameter("factor", 0.5, 1e-6, 50, 1.0);
  factor.log = true;
  const auto grown = [](double f) { return VectorX(50 * (1 / (0.5 + f) - 1 / 1.5) * axis(4, 0)); };
  const Effect e = effect("factor", {factor}, [&](const VectorX& values) { return grown(values(0)); });
  for (const double truth : {0.03, 0.05, 0.2}) {
    const Seen s = seen(grown(truth));
    const Fit f = fit(s.observations, {{&e, {}}}, {}, test::values({50}));
    ASSERT_TRUE(f.found) << f.why;
    EXPECT_NEAR(f.values(0), truth, 1e-3 * truth);
  }
  const Seen gone = seen(grown(0));
  EXPECT_LT(fit(gone.observations, {{&e, {}}}, {}, test::values({50})).values(0), 1e-3);
}

// A plane machine whose loads are turned about z: turns about x and y change what is read by 1 − cos, alike to both
// sides, so that a one-sided difference has a slope of 4e-4. A search that follows it does not find the turn about z.
TEST(SearchLimits, WhatChangesAlikeToBothSidesHasNoSlope) {
  const Effect e = effect("turned",
                          {parameter("rx", 0.01, -0.8, 0.8, 0.0), parameter("ry", 0.01, -0.8, 0.8, 0.0),
                           parameter("rz", 0.01, -0.8, 0.8, 0.0)},
                          [](const VectorX& turn) {
                            return VectorX(300 * std::sin(turn(2)) * axis(4, 0) +
                                           80 * (std::cos(turn(0)) + std::cos(turn(1)) - 2) * axis(4, 1) +
                                           80 * (std::cos(turn(1)) - 1) * axis(4, 2));
                          });
  const Seen s = seen(300 * std::sin(0.03) * axis(4, 0) + 2 * axis(4, 1) - axis(4, 2));
  const FitProblem problem(s.observations, {{&e, {}}});
  const VectorX at = VectorX::Zero(3);
  MatrixX J;
  FreeResidual{&problem, at, {0, 1, 2}}.df(at, J);
  EXPECT_EQ(J.leftCols(2).norm(), 0);
  const Fit f = fit(s.observations, {{&e, {}}});
  ASSERT_TRUE(f.found) << f.why;
  EXPECT_NEAR(f.values(2), 0.03, 1e-5);
}

// A shape that changes nothing but the last digits, as the stiffness of a friction that slips throughout, has no slope.
TEST(SearchLimits, RoundingIsNoSlope) {
  const Effect e = effect("slips", {parameter("size", 1, 0, 100, 0.0), parameter("shape", 0.5, 0, 1, {})},
                          [](const VectorX& values) {
                            return VectorX(values(0) * axis(4, 0) + 3e-11 * std::sin(1e7 * values(1)) * axis(4, 1));
                          });
  const Seen s = seen(20 * axis(4, 0));
  const FitProblem problem(s.observations, {{&e, {}}});
  const VectorX at = problem.coordinates(test::values({20, 0.5}));
  MatrixX J;
  FreeResidual{&problem, at, {0, 1}}.df(at, J);
  EXPECT_GT(J.col(0).norm(), 1);
  EXPECT_EQ(J.col(1).norm(), 0);
}

// The sign of a size that vanishes at 1 is open: its search begins there, and the true value, 1.3, is the next valley
// of χ². A shallow valley at 1.85 lies below the start, χ² = 400 h(p)² with h(1) = 1 and h = 0.5 there.
TEST(SearchLimits, ASizeOfOpenSignBeginsWhereItVanishes) {
  const Effect e = effect("open", {parameter("p", 1.1, 0, 2, 1.0)}, [](const VectorX& values) {
    const double p = values(0);
    const double h = p < 1.6 ? (1.3 - p) / 0.3 : -1 + 0.5 * std::pow(std::sin(M_PI * (p - 1.6) / 0.5), 2);
    return VectorX(20 * (1 - h) * axis(4, 0));
  });
  const Seen s = seen(20 * axis(4, 0));
  const Fit f = fit(s.observations, {{&e, {}}});
  ASSERT_TRUE(f.found) << f.why;
  EXPECT_NEAR(f.values(0), 1.3, 1e-3);
  EXPECT_LT(f.chi2, 1e-3);
}

// A shape that was fitted to the end of its range, where it says nothing any more, is also tried where its search
// begins when another effect joins it: there both are right.
TEST(SearchLimits, AShapeAtItsEndIsTriedAtItsStartToo) {
  const Effect shaped = effect(
      "shaped", {parameter("size", 1, 0, 100, 0.0), parameter("shape", 0.5, 0, 1, {})}, [](const VectorX& values) {
        const double angle = std::min(values(1), 0.8);
        return VectorX(values(0) * (std::cos(angle) * axis(4, 0) + std::sin(angle) * axis(4, 1)));
      });
  const Effect other = along("other", axis(4, 2));
  const VectorX truth = 20 * (std::cos(0.5) * axis(4, 0) + std::sin(0.5) * axis(4, 1)) + 7 * axis(4, 2);
  const Seen s = seen(truth);
  const Fit f = fit(s.observations, {{&shaped, {}}, {&other, {}}}, test::values({20, 1}));
  ASSERT_TRUE(f.found) << f.why;
  EXPECT_NEAR(f.values(0), 20, 1e-2);
  EXPECT_NEAR(f.values(1), 0.5, 1e-3);
  EXPECT_NEAR(f.values(2), 7, 1e-2);
}

/// Turns in the plane of the first two axes as it grows: by `from` at first and, from `settled` on, by `to`.
Effect turning(const std::string& name, double start, double from, double to, double settled) {
  return effect(name, {parameter("size", start, -1000, 1000, 0.0)}, [=](const VectorX& values) {
    const double size = values(0), angle = from + (to - from) * std::min(1.0, std::abs(size) / settled);
    return VectorX(size * (std::cos(angle) * axis(4, 0) + std::sin(angle) * axis(4, 1)));
  });
}

/// The candidates for a first effect.
std::vector<Candidate> first_of(const Seen& s, const Candidates& all, double least) {
  return all.beside(s.observations, {}, fit_of_all(s.observations, {}, VectorX(0)), least);
}

// An effect that has turned away from its signature leaves that to be explained. It is not taken a second time, with
// another, where two are sought beside it.
TEST(SearchLimits, AnEffectIsNotTakenTwice) {
  const std::vector<Effect> effects = {turning("turns", 0.01, 0, M_PI / 2, 15), along("other", axis(4, 2))};
  const Seen s = seen(15 * axis(4, 1) + 12 * axis(4, 0) + 12 * axis(4, 2));
  const std::vector<Signature> all = signatures(s.observations, effects, 1);
  const Candidates candidates(all, 1);
  const Hypothesis before = {{&effects[0], {}}};
  const Fit alone = fit(s.observations, before, {}, test::values({15}));
  ASSERT_TRUE(alone.found);
  EXPECT_TRUE(candidates.two_beside(s.observations, {}, fit_of_all(s.observations, {}, VectorX(0)), -1e6, -1e6));
  EXPECT_FALSE(candidates.two_beside(s.observations, before, alone, -1e6, -1e6));
}

// The signature of a law at a place says 0.85 of what the law gains, 30 in χ²: more than a tenth less. It is fitted all
// the same where its odds with all of the gain, but not with a tenth more than said, are called for.
TEST(SearchLimits, ALawAtAPlaceThatGainsALittleMoreThanSaidIsFitted) {
  const double gain = 30, angle = std::acos(std::sqrt(0.85)), size = std::sqrt(gain);
  std::vector<Effect> law = {turning("law", 0.01, 0, angle, size)};
  law[0].place.emplace();
  const Seen s = seen(size * (std::cos(angle) * axis(4, 0) + std::sin(angle) * axis(4, 1)));
  const std::vector<Signature> all = signatures(s.observations, law, 1);
  ASSERT_EQ(all.size(), 1u);
  const double said = most_gain(all[0], s.observations.null_residual(), MatrixX(8, 0));
  ASSERT_NEAR(said, 0.85 * gain, 0.1);
  const Candidates candidates(all, 1);
  const double least = candidates.class_log_odds_of(all[0].effect, (1.1 * said + gain) / 2);
  const Candidate found = first_of(s, candidates, least).front();
  ASSERT_TRUE(found.fit.found);
  EXPECT_NEAR(found.gain, gain, 0.1);
  EXPECT_GT(found.class_log_odds, least);
}

// An effect explains χ² of 225. Another, which explains more where it is large, explains 2 · 15 · 9 cos a − 9² = 81 at
// most, with cos a = 0.6: far from the best, so that it is not fitted.
TEST(SearchLimits, WhatIsFarFromTheBestInAnySizeIsNotFitted) {
  const std::vector<Effect> effects = {along("best", axis(4, 0)),
                                       turning("other", 0.01, std::acos(std::sqrt(20.0 / 225)), std::acos(0.6), 8)};
  const Seen s = seen(15 * axis(4, 0));
  const std::vector<Signature> all = signatures(s.observations, effects, 1);
  ASSERT_EQ(all.size(), 2u);
  const std::vector<Candidate> found = first_of(s, Candidates(all, 1).in_larger_sizes(), -1e6);
  EXPECT_NEAR(found[0].gain, 225, 0.1);
  EXPECT_FALSE(found[1].fit.found);
  const Fit alone = fit(s.observations, {{&effects[1], {}}}, {}, test::values({9}));
  EXPECT_NEAR(225 - alone.chi2, 81, 0.1);
}

// Beside something unknown that common patterns can take, an effect stays whose absence leaves more than 1.25 times as
// much, where all effects together are most of the matter.
TEST(SearchLimits, AnEffectThatIsAQuarterOfWhatIsLeftStaysBesideTheUnknown) {
  const std::vector<Effect> effects = {along("large", axis(4, 0)), along("small", axis(4, 1))};
  const auto named = [&](double size) {
    const Seen s = seen(100 * axis(4, 0) + size * axis(4, 1) + 20 * axis(4, 2));
    const Hypothesis h = {{&effects[0], {}}, {&effects[1], {}}};
    const Fit f = fit_of_all(s.observations, h, test::values({100, size}));
    EXPECT_NEAR(f.chi2, 400, 0.1);
    const Explanations all{signatures(s.observations, effects, 1)};
    const Candidates candidates(all.laws, 1);
    return named_beside_unknown(s.observations.whitened_patterns(), all, candidates, {s.observations, h, f, {}, {}})
        .effects.size();
  };
  EXPECT_EQ(named(20 * std::sqrt(0.20)), 1u);  // 1.20 times as much
  EXPECT_EQ(named(20 * std::sqrt(0.30)), 2u);
  EXPECT_EQ(named(20 * std::sqrt(1.40)), 2u);  // 2.4
}

// Beside two large effects the readings show 20 (A + B) = 40 u of A = u + w and B = u − w, |w| = 2 |u|, each of which
// alone explains a fifth of that. Two others, which go the two halves of u but for a little, come first and leave a
// twenty-sixth; of four effects these two are exchanged for A and B.
TEST(SearchLimits, TwoOfFourEffectsAreExchanged) {
  const auto e = [](Eigen::Index i) { return axis(8, i); };
  const double r = std::sqrt(0.5);
  const VectorX u = r * (e(2) + e(3)), w = 2 * e(4);
  const std::vector<Effect> effects = {along("x", e(0)),
                                       along("y", e(1)),
                                       along("first_half", (e(2) + 0.2 * e(5)).normalized()),
                                       along("other_half", (e(3) + 0.2 * e(6)).normalized()),
                                       along("a", u + w),
                                       along("b", u - w)};
  const Seen s = seen(200 * e(0) + 150 * e(1) + 40 * u);
  const std::vector<Signature> all = signatures(s.observations, effects, 1);
  const Candidates candidates(all, 1);
  const Selection found = select(s.observations, candidates, first_of(s, candidates, -1e6));
  std::set<std::string> names;
  for (const PlacedEffect& each : found.effects) names.insert(each.effect->name);
  EXPECT_EQ(names, (std::set<std::string>{"x", "y", "a", "b"}));
}

// An entry of which one of two parameters runs to nothing is no more than a law at a place. It is named all the same
// where it is likelier, because a common cause is; where the law is, the law.
TEST(SearchLimits, AnEntryAtABoundIsNamedWhereItIsLikelierThanTheLawThatDoesAsWell) {
  EffectParameter further = parameter("further", 1, 0.001, 100, 0.0);
  further.log = true;
  const Effect entry = effect("entry", {parameter("size", 1, -1000, 1000, 0.0), further}, [](const VectorX& values) {
    return VectorX(values(0) * axis(8, 0) + 0.3 * values(1) * axis(8, 1));
  });
  for (const std::size_t others : {0U, 12U}) {  // laws at other places, among which they share a prior
    std::vector<Effect> effects = {entry, along("law", axis(8, 0))};
    for (std::size_t i = 0; i < others; ++i)
      effects.push_back(
          along(fmt::format("other_{}", i), axis(8, 2 + as_index(i % 6)) + 0.01 * axis(8, as_index(i / 6))));
    for (std::size_t i = 1; i < effects.size(); ++i) {
      effects[i].place = subject::Place{};
      effects[i].place->path = effects[i].place->part = effects[i].name;
    }
    const Seen s = seen(10 * axis(8, 0));
    const std::vector<Signature> all = signatures(s.observations, effects, 1);
    const Candidates candidates(all, 1);
    const std::vector<Candidate> first = first_of(s, candidates, -1e6);
    const Selection found = select(s.observations, candidates, first);
    ASSERT_EQ(found.effects.size(), 1U) << others;
    EXPECT_EQ(found.effects.front().effect->name, first[0].log_odds > first[1].log_odds ? "entry" : "law") << others;
    EXPECT_EQ(first[0].log_odds > first[1].log_odds, others > 0) << "both are asked";
  }
}

// Beside two or more effects the search goes on only while they are not enough, whatever a third one explains.
TEST(SearchLimits, NoFurtherEffectIsLookedForWhereTheseAreEnough) {
  std::vector<Effect> effects;
  for (Eigen::Index i = 0; i < 3; ++i) effects.push_back(along(fmt::format("e{}", i), axis(6, i)));
  const Seen s = seen(30 * axis(6, 0) + 25 * axis(6, 1) + 20 * axis(6, 2));
  const std::vector<Signature> all = signatures(s.observations, effects, 1);
  const Candidates candidates(all, 1);
  const std::vector<Candidate> first = first_of(s, candidates, -1e6);
  std::vector<std::size_t> asked;
  const auto found = [&](bool enough) {
    asked.clear();
    return select(s.observations, candidates, first,
                  [&](const Selection& so_far) {
                    asked.push_back(so_far.effects.size());
                    return enough;
                  })
        .effects.size();
  };
  EXPECT_EQ(found(true), 2u);
  EXPECT_EQ(asked, std::vector<std::size_t>{2});
  EXPECT_EQ(found(false), 3u);
  EXPECT_EQ(asked, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(select(s.observations, candidates, first).effects.size(), 3u);
}

/// What a tilt of 20 and something unknown of 12 do, and a little in a reading of its own.
VectorX much() { return 20 * axis(8, 0) + 12 * axis(8, 2) + 5 * axis(8, 5); }

/// A little of the joint moves that reading alone, much of it jumps to the above.
const std::vector<Effect>& with_a_joint() {
  static const std::vector<Effect> all = {
      along("tilt", axis(8, 0)), along("play", axis(8, 1)),
      effect("joint", {parameter("size", 1, -1000, 1000, 0.0)}, [](const VectorX& values) {
        const double size = values(0);
        return size < 6 ? VectorX(size * axis(8, 5)) : VectorX(size / 9 * much());
      })};
  return all;
}

/// What is found where the readings show the joint, at 9, and play. Alone the joint leaves the play, without it 12² is
/// left: the play is such that it is this share of that beyond noise, which is the count of numbers.
Diagnosis with_a_large_joint(double share) {
  const double numbers = 16, play = std::sqrt(numbers + share * (12 * 12 - numbers));
  const Seen s = seen(much() + play * axis(8, 1));
  DiagnosisOptions o;
  o.comparison.as_recorded = true;
  o.bootstrap_sets = 199;
  return diagnose(s.observations.subject(), *s.data, with_a_joint(), o);
}

// A large effect takes the place of others only where alone it leaves less than half of what these leave.
TEST(SearchLimits, ALargeEffectMustLeaveLessThanHalf) {
  const Diagnosis less = with_a_large_joint(0.45), more = with_a_large_joint(0.55);
  EXPECT_EQ(less.verdict, Verdict::effect);
  ASSERT_EQ(less.missing.size(), 2u);
  EXPECT_EQ(less.missing[0].effect->name, "joint");
  EXPECT_NEAR(less.fit.values(0), 9, 1e-2);
  EXPECT_EQ(more.verdict, Verdict::unknown_effect);
  EXPECT_EQ(more.candidates.front().added().effect->name, "tilt");
}

}  // namespace
}  // namespace deflect
