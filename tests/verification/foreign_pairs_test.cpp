// Measurement sets of frames that hide two effects, made by foreign_pairs.py, which shares nothing with deflect: both
// are found, each by its name or in a tie with what these sensors cannot tell from it, and nothing else. Before several
// effects were weighed against larger tolerances, four of these five were called parts that deviate farther than
// declared, and in one only one effect was found. DEFLECT_FOREIGN_PAIRS names a folder with others.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "msa/frame/file/frame_file.h"
#include "tests/support/effects_everywhere.h"
#include "tests/support/paths.h"
#include "tests/verification/foreign_sets.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/subject/subject.h"

namespace deflect {
namespace {

const test::ForeignSets& sets() {
  static const test::ForeignSets all("foreign_pairs", "DEFLECT_FOREIGN_PAIRS");
  return all;
}

bool stands_for(const diagnosis::Diagnosis& d, const std::string& named, const std::string& hidden) {
  const auto has = [](const std::vector<std::string>& all, const std::string& one) {
    return std::find(all.begin(), all.end(), one) != all.end();
  };
  return named == hidden ||
         std::any_of(d.indistinguishable.begin(), d.indistinguishable.end(),
                     [&](const std::vector<std::string>& tie) { return has(tie, named) && has(tie, hidden); });
}

class ForeignPair : public testing::TestWithParam<std::string> {};

TEST_P(ForeignPair, BothAreFoundAndNothingElse) {
  const Json truth = sets().truths.at(GetParam());
  const subject::Subject s = frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames" /
                                               (truth.at("frame").get<std::string>() + ".yaml"));
  const auto data = s.placed(measurement::read_measurements(sets().folder / GetParam(), s.instruments()));
  const std::vector<effects::Effect> all = test::effects_everywhere(s);
  const diagnosis::Diagnosis d = diagnosis::diagnose(s, data, all, {{}, 199});
  std::vector<std::string> named;
  for (const effects::PlacedEffect& e : d.missing) named.push_back(e.effect->name);
  const std::string said =
      fmt::format("{}: {}", diagnosis::verdict_names[static_cast<int>(d.verdict)], fmt::join(named, ", "));
  ASSERT_EQ(named.size(), 2u) << said;
  for (const std::string hidden : truth.at("effects"))
    EXPECT_TRUE(stands_for(d, named[0], hidden) || stands_for(d, named[1], hidden)) << hidden << "; " << said;
  EXPECT_NE(d.verdict, diagnosis::Verdict::unknown_effect) << said;
  EXPECT_LT(d.probability_larger_tolerances, 0.5) << said;
  double sum = d.probability_nothing + d.probability_unknown;
  for (const diagnosis::Candidate& c : d.candidates) sum += c.probability;
  EXPECT_NEAR(sum, 1, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Sets, ForeignPair, testing::ValuesIn(sets().names()),
                         [](const auto& set) { return test::test_name(set.param); });

}  // namespace
}  // namespace deflect
