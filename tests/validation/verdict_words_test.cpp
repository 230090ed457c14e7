// Verdicts say what their own numbers say.
#include "validation/report/verdict_words.h"

#include <gtest/gtest.h>

#include <random>
#include <regex>

#include "tests/support/devices.h"
#include "tests/support/effects.h"

namespace deflect {
namespace {

using namespace compare;
using namespace diagnosis;
using namespace report;

bool has(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

/// The numbers of a sentence, in order.
std::vector<double> numbers(const std::string& text) {
  static const std::regex number(R"([0-9]+(\.[0-9]+)?(e[+-][0-9]+)?)");
  std::vector<double> out;
  for (std::sregex_iterator i(text.begin(), text.end(), number), end; i != end; ++i) out.push_back(std::stod(i->str()));
  return out;
}

Comparison comparison(double rmse, double noise, double chi2, double chi2_left, int findings) {
  Comparison c;
  c.readings = 720;
  c.study.values = {{0, 0, 1e-4, 2e-6}};
  c.kept_rmse = c.all.rmse = rmse;
  c.all.measured = 1e-4;
  c.noise_and_tolerances = noise;
  c.chi2_per_dof = chi2;
  c.unexplained_chi2_per_dof = chi2_left;
  c.findings.resize(static_cast<std::size_t>(findings));
  return c;
}

TEST(VerdictWords, NothingIsMissingOnlyWhereTheNumbersPrintedSaySo) {
  EXPECT_EQ(verdict_words(comparison(2.13e-6, 2.1e-6, 1.05, 1.02, 0)),
            "Nothing is missing that these readings can show: what is left is 2.13 µm rms, 1.02 times what noise and "
            "tolerances give (chi2 per degree of freedom).");
  // Less than noise and tolerances in size, but not in all readings together.
  EXPECT_EQ(verdict_words(comparison(2.82e-6, 2.97e-6, 1.61, 1.45, 0)),
            "Something is missing, and none of the patterns looked for describes it: what is left is 2.82 µm rms, 1.45 "
            "times what noise and tolerances give (chi2 per degree of freedom).");
  for (const double chi2 : {1.2951, 1.2999, 1.3001, 1.3049, 1.3051, 1.31}) {
    const std::string text = verdict_words(comparison(2e-6, 2e-6, chi2, chi2, 0));
    EXPECT_EQ(has(text, "Nothing is missing"), numbers(text).at(1) <= 1.3) << text;
  }
}

TEST(VerdictWords, WhatIsMissingIsSaidInTheNumbersInWhichItShows) {
  const std::string large = verdict_words(comparison(20e-6, 2e-6, 100, 1.1, 1));
  EXPECT_TRUE(has(large, "fails by 19.90 µm rms beyond noise and tolerances (20 % of what was measured)")) << large;
  // Within noise and tolerances: no size beyond them is claimed.
  const std::string small = verdict_words(comparison(2.0e-6, 2.1e-6, 1.214, 1.213, 1));
  EXPECT_FALSE(has(small, "beyond")) << small;
  EXPECT_TRUE(has(small, "chi2 per degree of freedom from 1.214 to 1.213")) << small;
}

TEST(VerdictWords, OutliersAreTheHeadlineAboveOneInTwenty) {
  EXPECT_EQ(outlier_words(36, 720), "");
  EXPECT_TRUE(has(outlier_words(37, 720), "37 of 720 readings (5.1 %) are gross outliers"));
  EXPECT_EQ(in_play_words(0, 288), "");
  EXPECT_TRUE(has(in_play_words(32, 288), "at 32 of 288 readings the load leaves play open"));
  Comparison c = comparison(2e-6, 2e-6, 1, 1, 0);
  c.set_aside.resize(72);
  EXPECT_TRUE(verdict_words(c).starts_with("72 of 720 readings (10.0 %) are gross outliers")) << verdict_words(c);
}

TEST(VerdictWords, AMistakeOfRecordingComesFirst) {
  Comparison c = comparison(1e-3, 2e-6, 1e5, 1e5, 2);
  c.mistakes = {{{"load_in_kgf"}, "these data look like loads in kgf"}};
  EXPECT_EQ(verdict_words(c), "Before anything else: these data look like loads in kgf.");
  Diagnosis d;
  d.mistakes = c.mistakes;
  EXPECT_EQ(verdict_words(d), "Before anything else: these data look like loads in kgf.");
}

TEST(VerdictWords, AnErrorIsSaidToFallWhereItFallsAsPrinted) {
  std::mt19937 random(1);
  Diagnosis d;
  d.verdict = Verdict::effect;
  d.missing = {{&test::effect("load_misalignment"), {}}};
  d.noise_floor = 2e-6;
  for (int i = 0; i < 200; ++i) {
    d.baseline.rmse = test::uniform(random, 2e-6, 2.2e-6);
    d.final.rmse = test::uniform(random, 2e-6, 2.2e-6);
    d.baseline.chi2_per_dof = test::uniform(random, 1.19, 1.2);
    d.final.chi2_per_dof = test::uniform(random, 1.18, 1.2);
    const std::string text = verdict_words(d);
    const std::vector<double> n = numbers(text);
    if (has(text, "the error falls")) {
      EXPECT_LT(n.at(1), n.at(0)) << text;
      EXPECT_GE(n.at(2), 1) << text;
    } else if (has(text, "rises with it")) {
      EXPECT_GT(n.at(1), n.at(0)) << text;
      EXPECT_LT(n.back(), n.at(n.size() - 2)) << text;
    } else if (has(text, "chi2 per degree of freedom falls")) {
      EXPECT_LT(n.back(), n.at(n.size() - 2)) << text;
    } else {
      EXPECT_TRUE(has(text, "does not fall")) << text;
    }
    if (d.final.rmse > 1.02 * d.baseline.rmse && d.final.chi2_per_dof < 1.19) {
      EXPECT_TRUE(has(text, "rises with it")) << text;
    }
  }
}

// The ids of a tie have no leg; the sentences say which one was fitted.
TEST(VerdictWords, ATieSaysTheLegOfAnEffectOfOneLeg) {
  const effects::PlacedEffect leg{&test::effect("leg_defect"), 5}, platform{&test::effect("platform_flexibility"), {}};
  Diagnosis d;
  d.verdict = Verdict::ambiguous;
  d.missing = {leg};
  d.indistinguishable = {{"leg_defect", "platform_flexibility"}};
  Tie tie;
  for (const effects::PlacedEffect& e : {leg, platform}) {
    tie.names.push_back(e.effect->name);
    tie.rivals.emplace_back().hypothesis = {e};
  }
  d.ties.push_back(tie);
  EXPECT_TRUE(has(verdict_words(d), "what of: leg_defect (leg 5) or platform_flexibility. Best: ")) << verdict_words(d);
  EXPECT_TRUE(has(headline_words(d), test::effect("leg_defect").title + ": leg 5 – or – " +
                                         test::effect("platform_flexibility").title + "."))
      << headline_words(d);
}

TEST(VerdictWords, SeveralTitlesMakeOneSentence) {
  Diagnosis d;
  d.verdict = Verdict::unknown_effect;
  d.pattern = "it grows with z";
  d.missing = {
      {&test::effect("joint_clearance"), {}}, {&test::effect("load_gain"), {}}, {&test::effect("modulus"), {}}};
  const std::string said = verdict_words(d), headline = headline_words(d);
  EXPECT_TRUE(has(said, ", not even with this: Every leg has play")) << said;
  for (const std::string& text : {said, headline}) {
    EXPECT_TRUE(has(text, "; and the load cell reads")) << text;
    EXPECT_TRUE(has(text, "; and Young's modulus")) << text;
  }
}

TEST(VerdictWords, NoiseExplainsOnlyWhatItExplains) {
  Diagnosis d;
  d.baseline = {4637e-6, 4637e-6, 5.4e6};
  EXPECT_FALSE(has(verdict_words(d), "Nothing is missing")) << verdict_words(d);
  d.baseline = {2.1e-6, 2.1e-6, 1.04};
  EXPECT_TRUE(verdict_words(d).starts_with("Nothing is missing that these data can show: what is left is 2.10 µm"));
}

}  // namespace
}  // namespace deflect
