// 95 % intervals by the profile of χ²: where they end, and how often they hold the truth.
#include "validation/diagnosis/interval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "tests/support/bar.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "validation/effects/place_effects.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"
#include "validation/subject/simulate_frame.h"

namespace deflect {
namespace {

using namespace diagnosis;
using namespace effects;
using namespace measurement;
using subject::Subject;

const Subject& machine() {
  static const Subject s = test::device("haptic-6psu-ideal-joints");
  return s;
}

// A bar between two posts, pushed to and fro: it rubs beside an elastic pad at its middle. σ is a hundredth of what it
// reads, as coarse as makes the stiffness of the friction uncertain by a fifth or so.
const Subject& rubbing_bar() {
  static const Subject s = test::bar_on_a_pad("modulus: 1 %, load: 0.2 %, spring.uz.stiffness: 1 %");
  return s;
}

const Effect& at_place(const Subject& s, const std::string& name) {
  static std::vector<std::unique_ptr<Effect>> kept;
  for (Effect& e : place_effects(s, test::all_effects()))
    if (e.name == name) return *kept.emplace_back(std::make_unique<Effect>(std::move(e)));
  throw std::logic_error("no effect " + name);
}

/// A hypothesis fitted to readings of a subject that has it with these values, as a diagnosis fits what it names.
struct Fitted {
  std::shared_ptr<const Measurements> data;  // to which the observations point
  Observations seen;
  Hypothesis h;
  Fit fit;

  double chi2(const VectorX& values) const {
    return seen.whitened_residual(with_effect(seen.subject(), {h.front(), values})).squaredNorm();
  }
};

Fitted fitted(const Subject& s, const PlacedEffect& e, const VectorX& values, std::uint64_t seed,
              const std::string& campaign) {
  const Subject truth = with_effect(s, {e, values});
  prediction::SimulationOptions o;
  o.seed = seed;
  const auto data = std::make_shared<const Measurements>(
      s.machine() ? simulate(*truth.machine(), prediction::campaign(campaign, *s.machine(), 50, 1), o)
                  : subject::simulate_frame(*truth.frame(), subject::frame_campaign(campaign, *s.frame(), 1), o));
  const Observations first(s, *data, {});
  const Hypothesis h = {e};
  const Fit begun = fit(first, h);
  Observations seen = first.granted(subject_with(first, h, begun.values));
  seen = seen.weighed_for(subject_with(seen, h, begun.values));
  Fit again = fit_of_all(seen, h, begun.values);
  again = with_intervals(seen, h, std::move(again), 1);
  return {data, std::move(seen), h, std::move(again)};
}

Fit parabolic(Fit f) {
  f.limits.clear();
  return f;
}

// The size of an effect that changes the readings in proportion to it.
TEST(Intervals, TheParabolaIsKeptWhereItIsRight) {
  const Fitted f = fitted(machine(), {&test::effect("load_gain"), {}}, test::values({1.2}), 1, "paper");
  EXPECT_EQ(interval95(f.h, f.fit, 0), interval95(f.h, parabolic(f.fit), 0));
}

// √(χ² − least χ²) is 1.96 there to a fortieth of it, so χ² has risen by 3.65 to 4.04.
TEST(Intervals, EndWhereChiSquareHasRisenByItsQuantile) {
  struct Case {
    const char* effect;
    std::optional<int> leg;
    double value;
  };
  bool searched = false;
  for (const Case& c : {Case{"leg_defect", 2, 0.35}, {"joint_clearance", {}, 0.003}, {"hertz_contact", {}, 1e-4}}) {
    const Fitted f = fitted(machine(), {&test::effect(c.effect), c.leg}, test::values({c.value}), 3, "paper");
    const auto [low, high] = interval95(f.h, f.fit, 0);
    const EffectParameter& p = test::effect(c.effect).parameters.front();
    for (const double end : {low, high}) {
      if (end == p.low || end == p.high) continue;
      EXPECT_GT(f.chi2(test::values({end})) - f.fit.chi2, 3.64) << c.effect << " " << end;
      EXPECT_LT(f.chi2(test::values({end})) - f.fit.chi2, 4.05) << c.effect << " " << end;
    }
    searched = searched || interval95(f.h, parabolic(f.fit), 0) != f.fit.limits.front();
  }
  EXPECT_TRUE(searched);  // a leg that has lost two thirds of its stiffness is no parabola
}

// Readings of a bar that sticks as if clamped do not say how stiff it sticks: nothing bounds that upwards.
TEST(Intervals, WhatTheDataDoNotBoundEndsAtTheParametersBound) {
  const Effect& friction = at_place(rubbing_bar(), "friction@spring.pad.uz");
  const Fitted f = fitted(rubbing_bar(), {&friction, {}}, test::values({100, 1e6}), 2, "cycle");
  ASSERT_TRUE(f.fit.found);
  const auto [low, high] = interval95(f.h, f.fit, 1);
  EXPECT_NEAR(high / friction.parameters[1].high, 1, 1e-14);  // a logarithm of 20 is known to 4e-15
  EXPECT_GT(low, 500);
}

/// How many of the draws' intervals hold the parameter, of 36 draws or of DEFLECT_DRAWS.
int draws() {
  const char* given = std::getenv("DEFLECT_DRAWS");
  return given ? std::atoi(given) : 36;
}

void expect_to_hold(const Subject& s, const PlacedEffect& e, const VectorX& values, Eigen::Index parameter,
                    const std::string& campaign) {
  const int n = draws();
  int held = 0, by_parabola = 0;
  for (int i = 0; i < n; ++i) {
    const Fitted f = fitted(s, e, values, 100 + static_cast<std::uint64_t>(i), campaign);
    const auto holds = [&](const Fit& fit) {
      const auto [low, high] = interval95(f.h, fit, static_cast<std::size_t>(parameter));
      return low <= values(parameter) && values(parameter) <= high;
    };
    held += holds(f.fit);
    by_parabola += holds(parabolic(f.fit));
  }
  testing::Test::RecordProperty("by_parabola", by_parabola);
  std::printf("%s: %d of %d, by the parabola %d\n", e.effect->name.c_str(), held, n, by_parabola);
  // 3.3 standard deviations below the mean of a binomial of .95. Of 36 draws fewer than 29 hold once in 3000 tests.
  EXPECT_GE(held, std::floor(0.95 * n - 3.3 * std::sqrt(0.95 * 0.05 * n))) << "of " << n;
}

TEST(Intervals, HoldAClearanceAsOftenAsTheySay) {
  expect_to_hold(machine(), {&test::effect("joint_clearance"), {}}, test::values({0.002}), 0, "paper");
}

TEST(Intervals, HoldADamagedLegAsOftenAsTheySay) {
  expect_to_hold(machine(), {&test::effect("leg_defect"), 2}, test::values({0.35}), 0, "paper");
}

TEST(Intervals, HoldAFrictionsStiffnessAsOftenAsTheySay) {
  const Effect& friction = at_place(rubbing_bar(), "friction@spring.pad.uz");
  expect_to_hold(rubbing_bar(), {&friction, {}}, test::values({60, 1000}), 1, "cycle");
}

}  // namespace
}  // namespace deflect
