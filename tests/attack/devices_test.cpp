// Random devices against the force method. DEFLECT_ATTACK=10000 test_attack --gtest_filter='*OnDemand*' prints the
// table of as many.
#include <gtest/gtest.h>

#include "tests/attack/count.h"
#include "tests/attack/device_judge.h"
#include "tests/attack/table.h"

namespace deflect::attack {
namespace {

Table judged(unsigned first, unsigned last, unsigned step) {
  Table table;
  for (unsigned seed = first; seed < last; seed += step) {
    const RandomDevice random = random_device(seed);
    const DeviceJudgement j = judge_apart(random);
    table.add(device_class_names[static_cast<int>(j.kind)], j.outcome, j.error, j.condition, j.between);
    if (is_wrong(j.outcome)) table.failures += reproduction(random, j) + "\n";
  }
  return table;
}

class RandomDevices : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomDevices, AreAnsweredRightByBothTheoriesOrRefusedRightly) {
  const Table table = judged(GetParam(), usual_count, shards);
  EXPECT_TRUE(table.failures.empty()) << table.failures;
}

INSTANTIATE_TEST_SUITE_P(Shard, RandomDevices, ::testing::Range(0u, shards));

TEST(RandomDevicesOnDemand, AreAnsweredRightByBothTheoriesOrRefusedRightly) {
  if (count_on_demand() == 0) GTEST_SKIP() << "set DEFLECT_ATTACK to the number of devices";
  const Table table = judged(0, count_on_demand(), 1);
  fmt::print("{}", table.text("devices"));
  EXPECT_TRUE(table.failures.empty()) << table.failures;
}

// Devices of extreme ratios are left to the linear ones.
Table judged_nonlinear(unsigned first, unsigned last, unsigned step) {
  Table table;
  for (unsigned seed = first; seed < last; seed += step) {
    const RandomDevice random = with_nonlinear_laws(random_device(seed));
    if (random.kind == DeviceKind::stiff_and_soft) continue;
    const DeviceJudgement j = judge_apart(random, judge_agreement);
    table.add(device_kind_names[static_cast<int>(random.kind)], j.outcome, 0, 1, j.between);
    if (is_wrong(j.outcome)) table.failures += reproduction(random, j) + "\n";
  }
  return table;
}

// Each was refused once, or answered without a word of what is idle: eigenvectors of a joint's 6×6 stiffness lost the
// soft directions; stiff legs that hold each other shared a load by rounding; an idle motion was not seen where the
// pieces' coordinates are scaled unevenly, and rounding then drove it.
TEST(RandomDevices, OfExtremeRatiosKeepTheirDigitsAndTellWhatIsIdle) {
  for (const unsigned seed : {1124u, 1694u, 1709u, 1843u, 1959u, 2024u, 2429u, 2537u, 2624u, 2661u, 2774u, 2909u, 4089u,
                              6249u, 6251u, 7219u, 8119u, 8244u}) {
    const RandomDevice random = random_device(seed);
    const DeviceJudgement j = judge_apart(random);
    EXPECT_FALSE(is_wrong(j.outcome)) << reproduction(random, j);
  }
}

class NonlinearDevices : public ::testing::TestWithParam<unsigned> {};

TEST_P(NonlinearDevices, AreAnsweredAlikeByBothTheoriesOrRefusedWithTheCause) {
  const Table table = judged_nonlinear(GetParam(), usual_count, shards);
  EXPECT_TRUE(table.failures.empty()) << table.failures;
}

INSTANTIATE_TEST_SUITE_P(Shard, NonlinearDevices, ::testing::Range(0u, shards));

// Play that moves inner bodies alone, or that no force reaches but its rounding: refused once, because the search went
// on among numbers of 1e-30, or because the MSA gave K without a twist of the platform that was rounding.
TEST(NonlinearDevices, PlayThatNeverReachesThePlatformChangesNothing) {
  for (const unsigned seed : {1061u, 2668u, 5661u, 6851u, 7483u, 9521u}) {
    const RandomDevice random = with_nonlinear_laws(random_device(seed));
    const DeviceJudgement j = judge_apart(random, judge_agreement);
    EXPECT_EQ(j.outcome, Outcome::answered) << reproduction(random, j);
  }
}

// Power laws of small exponents that carry nothing threw Newton's steps to and fro in closed form; a one-sided law that
// rigid parts hold still got a force that was rounding over rounding.
TEST(NonlinearDevices, LawsThatCarryNothingAreSolved) {
  for (const unsigned seed : {858u, 1572u, 2005u, 2693u, 3248u, 4022u, 4042u, 4593u, 4712u, 7225u, 8132u}) {
    const RandomDevice random = with_nonlinear_laws(random_device(seed));
    const DeviceJudgement j = judge_apart(random, judge_agreement);
    EXPECT_EQ(j.outcome, Outcome::answered) << reproduction(random, j);
  }
}

// Forces of a stiff spring that stands in for a law, far larger than any in the device, left their rounding in the
// MSA's equilibrium; in closed form small offsets told of the linear rest what rounding told, though large ones had
// told it.
TEST(NonlinearDevices, OfGroupsWithStiffLawsKeepTheirDigits) {
  for (const unsigned seed : {697u, 3502u}) {
    const RandomDevice random = with_nonlinear_laws(random_device(seed));
    const DeviceJudgement j = judge_apart(random, judge_agreement);
    EXPECT_EQ(j.outcome, Outcome::answered) << reproduction(random, j);
    EXPECT_LE(j.between, 1e-9) << reproduction(random, j);
  }
}

TEST(NonlinearDevicesOnDemand, AreAnsweredAlikeByBothTheoriesOrRefusedWithTheCause) {
  if (count_on_demand() == 0) GTEST_SKIP() << "set DEFLECT_ATTACK to the number of devices";
  const Table table = judged_nonlinear(0, count_on_demand(), 1);
  fmt::print("{}", table.text("devices of nonlinear laws"));
  EXPECT_TRUE(table.failures.empty()) << table.failures;
}

}  // namespace
}  // namespace deflect::attack
