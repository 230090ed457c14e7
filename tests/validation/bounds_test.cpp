// When a fitted value counts as one that has run to its bound.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/effects.h"
#include "validation/diagnosis/fit_problem.h"
#include "validation/diagnosis/hypothesis.h"

namespace deflect::diagnosis {
namespace {

effects::EffectParameter parameter(double low, double high, bool log, std::optional<double> vanishes = {}) {
  effects::EffectParameter p = test::effect("modulus").parameters.front();
  p.low = low, p.high = high, p.log = log, p.vanishes = vanishes;
  p.start = log ? std::sqrt(low * high) : (low + high) / 2;
  return p;
}

effects::Effect with(std::vector<effects::EffectParameter> parameters) {
  effects::Effect e = test::effect("modulus");
  e.parameters = std::move(parameters);
  return e;
}

Fit found(std::initializer_list<double> values) {
  Fit f;
  f.values = test::values(values);
  f.found = true;
  return f;
}

TEST(Coordinates, AreSharesOfHalfTheRangeOrLogarithms) {
  const effects::EffectParameter linear = parameter(-2, 6, false), log = parameter(1e-3, 1e3, true);
  EXPECT_NEAR(coordinate(linear, 6) - coordinate(linear, -2), 2, 1e-15);
  EXPECT_NEAR(coordinate(log, 20) - coordinate(log, 2), std::log(10.0), 1e-15);
  for (const double value : {-1.7, 0.0, 3.3}) EXPECT_NEAR(value_at(linear, coordinate(linear, value)), value, 1e-14);
  for (const double value : {0.02, 7.0}) EXPECT_NEAR(value_at(log, coordinate(log, value)), value, 1e-14 * value);
  EXPECT_EQ(value_at(linear, 100), 6);
  EXPECT_EQ(value_at(log, -100), 1e-3);
}

// Within a thousandth of the range; of effects with several parameters.
TEST(RunsToABound, WithinAThousandthOfTheRange) {
  const effects::Effect two = with({parameter(-1, 3, false), parameter(1, 1e4, true)}),
                        one = with({parameter(-1, 3, false)});
  const Hypothesis h = {{&test::effect("modulus"), {}}, {&two, {}}};
  const double inside = std::pow(1e4, 0.0015), near = std::pow(1e4, 0.0005);
  EXPECT_FALSE(runs_to_a_bound(h, found({1, 1, 100})));
  EXPECT_FALSE(runs_to_a_bound(h, found({1, -1 + 4 * 0.0015, 1e4 / inside})));
  EXPECT_FALSE(runs_to_a_bound(h, found({1, 3 - 4 * 0.0015, inside})));
  EXPECT_TRUE(runs_to_a_bound(h, found({1, -1 + 4 * 0.0005, 100})));
  EXPECT_TRUE(runs_to_a_bound(h, found({1, 3 - 4 * 0.0005, 100})));
  EXPECT_TRUE(runs_to_a_bound(h, found({1, 1, near})));
  EXPECT_TRUE(runs_to_a_bound(h, found({1, 1, 1e4 / near})));
  const effects::Effect far =
      with({parameter(-1, 3, false), parameter(10, 11, false)});  // of the range, not of its end
  EXPECT_FALSE(runs_to_a_bound({{&far, {}}}, found({1, 10.0015})));
  EXPECT_TRUE(runs_to_a_bound({{&far, {}}}, found({1, 10.0005})));
  EXPECT_FALSE(runs_to_a_bound({{&one, {}}}, found({-1})));
  Fit none = found({1, -1, 100});
  none.found = false;
  EXPECT_FALSE(runs_to_a_bound(h, none));
}

// Of an effect with one parameter, at a bound where it is there. A factor of next to nothing is as large as can be.
TEST(WantsMore, AtABoundWhereTheEffectDoesNotVanish) {
  const double near = std::exp(5e-4), inside = std::exp(1.5e-3);
  const effects::Effect spring = with({parameter(10, 1e6, true, std::numeric_limits<double>::infinity())}),
                        gap = with({parameter(0, 2, false, 0.0)}), factor = with({parameter(1e-6, 1e6, true, 1.0)}),
                        two = with({parameter(0, 2, false), parameter(0, 2, false)});
  const auto wants = [](const effects::Effect& e, std::initializer_list<double> values) {
    return wants_more_than_there_can_be({{&e, {}}}, found(values));
  };
  EXPECT_TRUE(wants(spring, {10 * near}));
  EXPECT_FALSE(wants(spring, {10 * inside}));
  EXPECT_TRUE(wants(spring, {1e6 / near}));
  EXPECT_TRUE(wants(gap, {2 - 5e-4}));
  EXPECT_FALSE(wants(gap, {2 - 2e-3}));
  EXPECT_FALSE(wants(gap, {0}));
  EXPECT_FALSE(wants(factor, {1e-6}));  // a millionth of its start, 1
  EXPECT_TRUE(wants(factor, {1e6}));
  EXPECT_FALSE(wants(two, {2, 2}));
}

}  // namespace
}  // namespace deflect::diagnosis
