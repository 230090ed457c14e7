// Random frames against the oracles. DEFLECT_ATTACK=10000 test_attack --gtest_filter='*OnDemand*' prints the table of
// as many.
#include <gtest/gtest.h>

#include "tests/attack/count.h"
#include "tests/attack/law_forms.h"
#include "tests/attack/table.h"

namespace deflect::attack {
namespace {

using Roll = RandomFrame (*)(unsigned seed);

Table judged(unsigned first, unsigned last, unsigned step, Roll roll = random_frame) {
  Table table;
  for (unsigned seed = first; seed < last; seed += step) {
    const RandomFrame random = roll(seed);
    const Judgement j = judge(random);
    table.add(standing_names[static_cast<int>(j.standing)], j.outcome, j.error, j.condition);
    if (is_wrong(j.outcome)) table.failures += reproduction(random, j) + "\n";
  }
  return table;
}

class RandomFrames : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomFrames, AreAnsweredRightOrRefusedRightly) {
  const Table table = judged(GetParam(), usual_count, shards);
  EXPECT_TRUE(table.failures.empty()) << table.failures;
}

TEST_P(RandomFrames, WithLawsAreAnsweredRightOrRefusedRightly) {
  const Table table = judged(GetParam(), usual_count, shards, random_law_frame);
  EXPECT_TRUE(table.failures.empty()) << table.failures;
}

INSTANTIATE_TEST_SUITE_P(Shard, RandomFrames, ::testing::Range(0u, shards));

// The force of a member that spins idly within a rigid body; a rounded axis between two nodes of one body, which passed
// for a support; loads on clamped nodes, whose work on rounding was compared with itself.
TEST(RandomFrames, ThatWereOnceAnsweredWronglyOrRefusedWrongly) {
  for (const unsigned seed : {5995u, 24333u, 24730u, 30537u, 34229u}) {
    const RandomFrame random = random_frame(seed);
    const Judgement j = judge(random);
    EXPECT_FALSE(is_wrong(j.outcome)) << reproduction(random, j);
  }
}

TEST(RandomFramesOnDemand, AreAnsweredRightOrRefusedRightly) {
  if (count_on_demand() == 0) GTEST_SKIP() << "set DEFLECT_ATTACK to the number of frames";
  const Table table = judged(0, count_on_demand(), 1);
  fmt::print("{}", table.text("frames"));
  EXPECT_TRUE(table.failures.empty()) << table.failures;
}

TEST(RandomFramesOnDemand, WithLawsAreAnsweredRightOrRefusedRightly) {
  if (count_on_demand() == 0) GTEST_SKIP() << "set DEFLECT_ATTACK to the number of frames";
  const Table table = judged(0, count_on_demand(), 1, random_law_frame);
  fmt::print("{}", table.text("frames with laws"));
  EXPECT_TRUE(table.failures.empty()) << table.failures;
}

}  // namespace
}  // namespace deflect::attack
