// Larger tolerances as a rival of missing effects: what they say of a frame as declared and of one built worse.
#include "validation/diagnosis/larger_tolerances.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

#include "msa/frame/file/frame_file.h"
#include "tests/support/effects.h"
#include "tests/support/effects_everywhere.h"
#include "tests/support/paths.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/report/verdict_words.h"
#include "validation/subject/simulate_frame.h"

namespace deflect {
namespace {

const subject::Subject& truss() {
  static const subject::Subject s =
      frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames/truss-45.yaml");
  return s;
}

measurement::Measurements built_with(double tolerances, std::uint64_t seed, const std::vector<Edit>& edits = {}) {
  prediction::SimulationOptions o;
  o.tolerances = tolerances;
  o.seed = seed;
  frame::FrameDescription f = frame::edited(*truss().frame(), edits);
  f.geometry = Geometry::finite;  // not the one that the diagnosis uses
  return subject::simulate_frame(f, subject::frame_campaign("random", f, seed), o);
}

// With n tolerances that the readings see well, ln L(2)/L(1) is n (½ 2² (1 − 2⁻²) − ln 2) = 0.8 n on the average where
// they are twice as large, and n (½ (1 − 2⁻²) − ln 2) = −0.3 n where they are as declared.
TEST(LargerTolerances, AreSeenWhereTheyAre) {
  std::vector<double> odds;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const measurement::Measurements twice = built_with(2, seed), once = built_with(1, seed);
    const diagnosis::LargerTolerances larger =
        diagnosis::larger_tolerances(diagnosis::Observations(truss(), twice, {}));
    EXPECT_GT(larger.log_odds, 0) << seed;
    EXPECT_NEAR(larger.scale, 2, 0.7) << seed;
    odds.push_back(std::exp(diagnosis::larger_tolerances(diagnosis::Observations(truss(), once, {})).log_odds));
  }
  std::sort(odds.begin(), odds.end());
  EXPECT_LT(odds[2], 0.2) << "of most machines that are built as declared";
}

// Before they were a rival of effects this set was called a modulus.
TEST(LargerTolerances, AreToldInPlaceOfAnEffect) {
  const diagnosis::Diagnosis d = diagnosis::diagnose(truss(), built_with(2, 2), test::all_effects(), {{}, 199});
  EXPECT_EQ(d.verdict, diagnosis::Verdict::nothing_missing);
  EXPECT_GT(d.probability_larger_tolerances, 0.5);
  EXPECT_LE(d.probability_larger_tolerances, d.probability_nothing);
  EXPECT_EQ(d.tolerance_scale, 1) << "they do not count as larger";
  const std::string said = report::verdict_words(d);
  EXPECT_NE(said.find(fmt::format("{:.1f} times as far as the tolerances", d.larger_tolerances)), std::string::npos)
      << said;
}

// A chord of less than half its stiffness, in a frame built two and a half times worse than declared: without the size
// of tolerances that shows beside the chord, something unknown was said to be left.
TEST(LargerTolerances, CountAsLargeAsTheyLookBesideWhatWasFound) {
  const std::vector<Edit> softer = {{"members.C1b.factor", "0.4", Edit::Action::multiply}};
  const std::vector<effects::Effect> everywhere = test::effects_everywhere(truss());
  for (const auto& [built, least, most] : {std::tuple{1.0, 1.0, 1.0}, {2.5, 1.5, 3.0}}) {
    const diagnosis::Diagnosis d = diagnosis::diagnose(truss(), built_with(built, 3, softer), everywhere, {{}, 199});
    EXPECT_FALSE(d.unexplained) << built;
    ASSERT_EQ(d.missing.size(), 1u) << built;
    bool told = diagnosis::name_of(d.missing.front()) == "factor@C1b";
    for (const std::vector<std::string>& tie : d.indistinguishable)
      told = told || std::find(tie.begin(), tie.end(), "factor@C1b") != tie.end();
    EXPECT_TRUE(told) << built;
    EXPECT_GE(d.tolerance_scale, least) << built;
    EXPECT_LE(d.tolerance_scale, most) << built;
  }
}

}  // namespace
}  // namespace deflect
