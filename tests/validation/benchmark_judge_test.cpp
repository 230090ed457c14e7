// The judge of the benchmark: what counts as right, partly right, missed and wrong with confidence.
#include <gtest/gtest.h>

#include "tests/benchmark/class_judge.h"

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

// Classes: modulus and guide_diameter do the same to the data, and so do base_tilt and its twin.
const EffectClass beams = {"modulus", "guide_diameter"}, base = {"base_tilt", "base_twin"};

TEST(ClassJudge, AnyOfTheClassIsRightAndATieWithOneOfIt) {
  EXPECT_TRUE(exactly(effect({"guide_diameter"}), {beams}));
  EXPECT_TRUE(exactly(ambiguous({"load_gain"}, {"load_gain", "modulus"}), {beams}));
  EXPECT_FALSE(exactly(ambiguous({"load_gain"}, {"load_gain", "base_tilt"}), {beams}));
  EXPECT_FALSE(exactly(effect({"modulus", "load_gain"}), {beams}));
  EXPECT_FALSE(exactly(unknown, {beams}));
  EXPECT_TRUE(exactly(nothing, {}));
  EXPECT_FALSE(exactly(effect({"modulus"}), {}));
}

TEST(ClassJudge, TwoHiddenOnesWantAnEffectEach) {
  EXPECT_TRUE(exactly(effect({"base_twin", "modulus"}), {beams, base}));
  EXPECT_FALSE(exactly(effect({"guide_diameter", "modulus"}), {beams, base})) << "one twice, the other not at all";
  EXPECT_FALSE(exactly(effect({"modulus"}), {beams, base}));
  EXPECT_TRUE(all_reported(effect({"base_twin", "modulus"}), {beams, base}));
  EXPECT_FALSE(all_reported(effect({"modulus"}), {beams, base}));
}

TEST(ClassJudge, WhatStandsForNothingHiddenIsFalse) {
  EXPECT_EQ(false_reports(effect({"base_twin", "load_gain"}), {beams, base}), 1U);
  EXPECT_EQ(false_reports(effect({"base_twin", "load_gain"}), {}), 2U);
  EXPECT_EQ(false_reports(ambiguous({"load_gain"}, {"load_gain", "modulus"}), {beams}), 0U);
  EXPECT_TRUE(confident_and_wrong(effect({"load_gain"}), {beams}));
  EXPECT_FALSE(confident_and_wrong(effect({"load_gain"}, 0.8), {beams}));
  EXPECT_FALSE(confident_and_wrong(effect({"load_gain", "modulus"}), {beams}));
  EXPECT_FALSE(confident_and_wrong(ambiguous({"load_gain"}, {"load_gain", "base_tilt"}), {beams}));
  EXPECT_FALSE(confident_and_wrong(nothing, {beams}));
}

}  // namespace
}  // namespace deflect::benchmark
