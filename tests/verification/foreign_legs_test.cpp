// Measurement sets of a Stewart platform with one leg, or all, worn, made by foreign_legs.py, which shares nothing with
// deflect: what is hidden is named or in a tie, in the right leg. Before laws of wear could act in one leg, play and
// friction of one were called another effect or unknown. DEFLECT_FOREIGN_LEGS names a folder with others, as the
// program writes them.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/devices.h"
#include "tests/support/effects_everywhere.h"
#include "tests/verification/foreign_sets.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/diagnosis/interval.h"
#include "validation/subject/subject.h"

namespace deflect {
namespace {

const test::ForeignSets& sets() {
  static const test::ForeignSets all("foreign_legs", "DEFLECT_FOREIGN_LEGS");
  return all;
}

class ForeignLeg : public testing::TestWithParam<std::string> {};

TEST_P(ForeignLeg, WhatIsWornIsNamedOrTiedInItsLeg) {
  const Json truth = sets().truths.at(GetParam());
  const subject::Subject s = test::device("stewart-6ups");
  const auto data = s.placed(measurement::read_measurements(sets().folder / GetParam(), s.instruments()));
  const std::vector<effects::Effect> all = test::effects_everywhere(s);
  const diagnosis::Diagnosis d = diagnosis::diagnose(s, data, all, {{}, 199});
  std::vector<std::string> found;
  for (const effects::PlacedEffect& e : d.missing) found.push_back(diagnosis::name_of(e));
  for (const diagnosis::Tie& tie : d.ties)
    for (const diagnosis::Candidate& c : tie.rivals) found.push_back(diagnosis::name_of(c.added()));
  const std::string said =
      fmt::format("{}: {}", diagnosis::verdict_names[static_cast<int>(d.verdict)], fmt::join(found, ", "));
  if (truth.at("effect").is_null()) {
    EXPECT_EQ(d.verdict, diagnosis::Verdict::nothing_missing) << said;
    return;
  }
  ASSERT_EQ(d.missing.size(), 1U) << said;
  EXPECT_FALSE(d.unexplained) << said;
  std::vector<effects::PlacedEffect> looked_for;
  for (const effects::Effect& e : all)
    if (e.name == truth.at("effect").get<std::string>())
      looked_for.push_back({&e, truth.at("leg").is_null() ? std::nullopt : std::optional(truth.at("leg").get<int>())});
  ASSERT_EQ(looked_for.size(), 1U);
  EXPECT_NE(std::find(found.begin(), found.end(), diagnosis::name_of(looked_for.front())), found.end()) << said;
  if (d.missing.front().effect != looked_for.front().effect) return;
  for (std::size_t i = 0; i < d.missing.front().effect->parameters.size(); ++i) {
    const std::string& name = d.missing.front().effect->parameters[i].name;
    if (!truth.at("parameters").contains(name)) continue;
    const auto [low, high] = diagnosis::interval95(d.missing, d.fit, i);
    const double value = d.fit.values(static_cast<Eigen::Index>(i)), hidden = truth.at("parameters").at(name);
    EXPECT_GE(hidden, value - test::far_off * (value - low)) << name << " = " << value;
    EXPECT_LE(hidden, value + test::far_off * (high - value)) << name << " = " << value;
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, ForeignLeg, testing::ValuesIn(sets().names()),
                         [](const auto& set) { return test::test_name(set.param); });

}  // namespace
}  // namespace deflect
