// Random frames against the oracles. DEFLECT_ATTACK=10000 makes each shard judge its share of as many.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

#include "tests/attack/count.h"
#include "tests/attack/frame_judge.h"

namespace deflect::attack {
namespace {

class RandomFrames : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomFrames, AreAnsweredRightOrRefusedRightly) {
  std::array<int, std::size(outcome_names)> counts{};
  std::array<int, std::size(standing_names)> kinds{};
  double worst = 0, worst_of_condition = 0;
  for (unsigned seed = GetParam(); seed < count_from_environment(500); seed += shards) {
    const RandomFrame random = random_frame(seed);
    const Judgement j = judge(random);
    ++counts[static_cast<std::size_t>(j.outcome)];
    ++kinds[static_cast<std::size_t>(j.standing)];
    if (is_wrong(j.outcome)) ADD_FAILURE() << reproduction(random, j);
    if (j.outcome != Outcome::answered) continue;
    worst = std::max(worst, j.error);
    worst_of_condition = std::max(worst_of_condition, j.error / j.condition);
  }
  std::string table;
  for (std::size_t i = 0; i < counts.size(); ++i) table += fmt::format("{} {}, ", outcome_names[i], counts[i]);
  for (std::size_t i = 0; i < kinds.size(); ++i) table += fmt::format("{} {}, ", standing_names[i], kinds[i]);
  fmt::print("{}largest error {:.1e}, over the condition {:.1e}\n", table, worst, worst_of_condition);
}

INSTANTIATE_TEST_SUITE_P(Shard, RandomFrames, ::testing::Range(0u, shards));

}  // namespace
}  // namespace deflect::attack
