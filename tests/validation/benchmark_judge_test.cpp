// The judge of the benchmark: what counts as right, partly right, missed and wrong with confidence.
#include <gtest/gtest.h>

#include "tests/benchmark/judge.h"

namespace deflect::benchmark {
namespace {

Answer effect(const std::vector<std::string>& missing, double probability = 0.99) {
  return {"effect", missing, {}, missing.front(), probability};
}
Answer ambiguous(const std::vector<std::string>& missing, const std::vector<std::string>& group) {
  return {"ambiguous", missing, {group}, missing.front(), 0.5};
}
const Answer nothing, unknown{"unknown_effect", {}, {}, "", 0};

TEST(BenchmarkJudge, OneEffect) {
  const Truth truth{{"modulus"}, false, ""};
  EXPECT_EQ(judge(truth, effect({"modulus"})), Outcome::right);
  EXPECT_EQ(judge(truth, ambiguous({"modulus"}, {"modulus", "load_gain"})), Outcome::right);
  EXPECT_EQ(judge(truth, ambiguous({"load_gain"}, {"load_gain", "modulus"})), Outcome::partly);
  EXPECT_EQ(judge(truth, effect({"modulus", "base_tilt"})), Outcome::partly);
  EXPECT_EQ(judge(truth, nothing), Outcome::missed);
  EXPECT_EQ(judge(truth, unknown), Outcome::missed);
  EXPECT_EQ(judge(truth, effect({"base_tilt"})), Outcome::wrong);
  EXPECT_EQ(judge(truth, effect({"base_tilt"}, 0.8)), Outcome::missed);
}

TEST(BenchmarkJudge, SeveralEffectsInAnyOrder) {
  const Truth truth{{"modulus", "base_tilt"}, false, ""};
  EXPECT_EQ(judge(truth, effect({"base_tilt", "modulus"})), Outcome::right);
  EXPECT_EQ(judge(truth, effect({"base_tilt"})), Outcome::partly);
}

TEST(BenchmarkJudge, TieMustBeSaid) {
  const Truth truth{{"modulus"}, false, "load_gain"};
  EXPECT_EQ(judge(truth, ambiguous({"load_gain"}, {"load_gain", "modulus", "base_tilt"})), Outcome::right);
  EXPECT_EQ(judge(truth, effect({"modulus"})), Outcome::partly);
  EXPECT_EQ(judge(truth, effect({"load_gain"})), Outcome::missed);
}

TEST(BenchmarkJudge, NothingAndUnknown) {
  EXPECT_EQ(judge({}, nothing), Outcome::right);
  EXPECT_EQ(judge({}, unknown), Outcome::missed);
  EXPECT_EQ(judge({}, effect({"modulus"})), Outcome::wrong);
  const Truth hidden{{"modulus"}, true, ""};
  EXPECT_EQ(judge(hidden, unknown), Outcome::right);
  EXPECT_EQ(judge(hidden, effect({"modulus"})), Outcome::wrong);
  EXPECT_EQ(judge(hidden, effect({"modulus"}, 0.5)), Outcome::missed);
}

TEST(BenchmarkJudge, ReportedOnceEach) {
  EXPECT_EQ(reported(ambiguous({"modulus"}, {"modulus", "load_gain"})),
            (std::vector<std::string>{"load_gain", "modulus"}));
}

}  // namespace
}  // namespace deflect::benchmark
