// Measurement sets of frames that hide two effects, made by foreign_pairs.py, which shares nothing with deflect: both
// are found, each by its name or in a tie with what these sensors cannot tell from it, and nothing else. Before several
// effects were weighed against larger tolerances, four of these five were called parts that deviate farther than
// declared, and in one only one effect was found.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "msa/frame/file/frame_file.h"
#include "tests/support/effects_everywhere.h"
#include "tests/support/paths.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/json/json_text.h"
#include "validation/subject/subject.h"

namespace deflect {
namespace {

std::filesystem::path folder_of_pairs() { return test::source_dir() + "/tests/verification/foreign_pairs"; }

Json pairs() {
  std::ifstream file(folder_of_pairs() / "truth.json");
  return Json::parse(file);
}

std::vector<std::string> sets_of_pairs() {
  const Json all = pairs();
  std::vector<std::string> out;
  for (auto each = all.begin(); each != all.end(); ++each) out.push_back(each.key());
  return out;
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
  const Json truth = pairs().at(GetParam());
  const subject::Subject s = frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames" /
                                               (truth.at("frame").get<std::string>() + ".yaml"));
  const auto data = s.placed(measurement::read_measurements(folder_of_pairs() / GetParam(), s.instruments()));
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

INSTANTIATE_TEST_SUITE_P(Sets, ForeignPair, testing::ValuesIn(sets_of_pairs()), [](const auto& set) {
  std::string name = set.param.substr(0, set.param.rfind('.'));
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
});

}  // namespace
}  // namespace deflect
