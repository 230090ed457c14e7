// By how much a plan expects readings to tell two effects apart, against regressions and fits that share only the
// predictions with it.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/plan/in_one_covariance.h"
#include "validation/measurement/joined.h"
#include "validation/plan/foresight.h"
#include "validation/plan/next_readings.h"
#include "validation/prediction/campaign.h"

namespace deflect::plan {
namespace {

using measurement::Measurements;
using test::values;

Measurements as_predicted(const char* campaign) {
  return filled_in(machine(), prediction::campaign(campaign, machine(), 50, 3), ForesightOptions(), true);
}

TEST(PlanSeparation, IsThatOfARegressionOnEverythingThatWasRead) {
  PlanOptions o;
  o.draws = 1;
  const Rival actuator = rival("actuator_compliance", values({2000})),
              platform = rival("platform_flexibility", values({1500}));
  const Measurements paper = as_predicted("paper"), rich = as_predicted("random");
  const InOneCovariance all(measurement::joined({paper, rich})), before(paper);
  const auto added = [&](const Rival& truth, const Rival& fitted) {
    return all.by_regression(truth, fitted) - before.by_regression(truth, fitted);
  };
  const double mean = (added(actuator, platform) + added(platform, actuator)) / 2;
  const Step step = expected_of(machine(), paper, rich, {actuator, platform}, o);
  ASSERT_EQ(step.pairs.size(), 1u);
  // The prior of a stiffness, e³ wide, stands in the plan and not in the regression.
  EXPECT_NEAR(step.pairs.front().separation, mean, 0.01 * mean);
}

/// A spring that hardens, fitted to readings of play: its derivatives say more than it can do.
TEST(PlanSeparation, WhereALawBendsTheRivalIsFittedToTheEnd) {
  PlanOptions o;
  o.draws = 1;
  const Measurements paper = as_predicted("paper"), more = as_predicted("cycle");
  const InOneCovariance all(measurement::joined({paper, more})), before(paper);
  const Rival play = rival("joint_clearance", values({0.001})),
              hardening = before.fitted_by_steps(play, rival("actuator_hardening", values({30000, 0.001})));
  const double bent = all.by_steps(play, hardening) - before.by_steps(play, hardening);
  // Gaps are linear in their readings.
  const double back = all.by_regression(hardening, play) - before.by_regression(hardening, play);
  const Step step = expected_of(machine(), paper, more, {play, hardening}, o);
  EXPECT_NEAR(step.pairs.front().separation, (bent + back) / 2, 0.02 * (bent + back) / 2);
  const double linear = all.by_regression(play, hardening) - before.by_regression(play, hardening);
  EXPECT_GT(std::abs(linear / bent - 1), 0.1) << linear << ' ' << bent;  // else the test shows nothing
}

/// A platform that hardly yields has no derivatives that lead to one that yields as much as actuators do.
TEST(PlanSeparation, ARivalFarFromItsFitIsFound) {
  PlanOptions o;
  o.draws = 1;
  const Measurements paper = as_predicted("paper"), more = as_predicted("cycle");
  const InOneCovariance all(measurement::joined({paper, more})), before(paper);
  const Rival actuator = rival("actuator_compliance", values({500})),
              platform = rival("platform_flexibility", values({3e5}));
  const auto added = [&](const Rival& truth, const Rival& fitted) {
    return all.by_steps(truth, fitted) - before.by_steps(truth, fitted);
  };
  const Pair found = expected_of(machine(), paper, more, {actuator, platform}, o).pairs.front();
  EXPECT_NEAR(found.if_a, added(actuator, platform), 0.5 + 0.02 * found.if_a);
  EXPECT_NEAR(found.if_b, added(platform, actuator), 0.5 + 0.02 * found.if_b);
}

}  // namespace
}  // namespace deflect::plan
