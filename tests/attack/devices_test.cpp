// Random devices against the force method. DEFLECT_ATTACK=10000 makes the shards judge as many.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

#include "tests/attack/count.h"
#include "tests/attack/device_judge.h"

namespace deflect::attack {
namespace {

class RandomDevices : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomDevices, AreAnsweredRightByBothTheoriesOrRefusedRightly) {
  std::array<int, std::size(outcome_names)> counts{};
  std::array<int, std::size(device_class_names)> kinds{};
  double worst = 0, between = 0, worst_of_condition = 0;
  for (unsigned seed = GetParam(); seed < count_from_environment(500); seed += shards) {
    const RandomDevice random = random_device(seed);
    const DeviceJudgement j = judge_apart(random);
    ++counts[static_cast<std::size_t>(j.outcome)];
    ++kinds[static_cast<std::size_t>(j.kind)];
    if (is_wrong(j.outcome)) ADD_FAILURE() << reproduction(random, j);
    if (j.outcome != Outcome::answered) continue;
    worst = std::max(worst, j.error);
    between = std::max(between, j.between);
    worst_of_condition = std::max(worst_of_condition, j.error / j.condition);
  }
  std::string table;
  for (std::size_t i = 0; i < counts.size(); ++i) table += fmt::format("{} {}, ", outcome_names[i], counts[i]);
  for (std::size_t i = 0; i < kinds.size(); ++i) table += fmt::format("{}: {}, ", device_class_names[i], kinds[i]);
  fmt::print("{}largest error {:.1e}, over the condition {:.1e}, theories {:.1e} apart\n", table, worst,
             worst_of_condition, between);
}

INSTANTIATE_TEST_SUITE_P(Shard, RandomDevices, ::testing::Range(0u, shards));

}  // namespace
}  // namespace deflect::attack
