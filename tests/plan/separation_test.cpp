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

/// Of three effects two do the same in every reading, so that the probability cannot reach what is wanted: once the
/// third is told from both, further readings would bring nothing.
TEST(PlanLength, EndsWhereReadingsBringNothing) {
  PlanOptions o;
  o.draws = 1;
  o.probability = 0.999;
  const std::vector<Rival> rivals = {rival("modulus", values({0.9})), rival("load_gain", values({1.1})),
                                     rival("actuator_compliance", values({500}))};
  const Plan p = next_readings(machine(), as_predicted("paper"), rivals, o);
  ASSERT_EQ(p.inseparable.size(), 1u);
  ASSERT_GE(p.steps.size(), 2u);
  EXPECT_LT(p.readings.readings.size(), o.readings);
  EXPECT_EQ(p.steps.back().readings, p.readings.readings.size());
  EXPECT_GT(p.steps.back().probability, p.steps[p.steps.size() - 2].probability);
}

/// A pose is approached once, those that were chosen first come first.
TEST(PlanOrder, IsPoseByPoseAsTheyWereChosen) {
  Possible possible;
  for (const std::size_t pose : {0u, 0u, 1u, 1u, 2u}) possible.blocks.push_back({possible.blocks.size(), 1, pose});
  EXPECT_EQ(pose_by_pose(possible, {3, 0, 2, 4, 1, 3}), (std::vector<std::size_t>{3, 2, 3, 0, 1, 4}));
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
