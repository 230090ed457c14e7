// Measurement sets of an arm made by foreign_arms.py, which shares nothing with deflect: what is hidden in each is
// found, or tied with what these readings cannot tell from it, and its values are right. Some are in
// tests/verification/foreign_arms; DEFLECT_FOREIGN_ARMS names a folder with others, as the program writes them.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "msa/mechanism/device_file.h"
#include "tests/support/effects.h"
#include "tests/support/paths.h"
#include "tests/verification/foreign_sets.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/diagnosis/interval.h"
#include "validation/effects/place_effects.h"
#include "validation/subject/subject.h"

namespace deflect {
namespace {

const test::ForeignSets& sets() {
  static const test::ForeignSets all("foreign_arms", "DEFLECT_FOREIGN_ARMS");
  return all;
}

void expect_values(const diagnosis::Diagnosis& d, const Json& hidden) {
  std::size_t at = 0;
  for (const effects::PlacedEffect& e : d.missing)
    for (const effects::EffectParameter& p : e.effect->parameters) {
      const auto [low, high] = diagnosis::interval95(d.missing, d.fit, at++);
      if (!hidden.contains(e.effect->name) || !hidden.at(e.effect->name).contains(p.name)) continue;
      const double value = d.fit.values(static_cast<Eigen::Index>(at) - 1);
      const double truth = hidden.at(e.effect->name).at(p.name);
      EXPECT_GE(truth, value - test::far_off * (value - low)) << e.effect->name << " " << p.name << " = " << value;
      EXPECT_LE(truth, value + test::far_off * (high - value)) << e.effect->name << " " << p.name << " = " << value;
    }
}

class ForeignArm : public testing::TestWithParam<std::string> {};

TEST_P(ForeignArm, WhatIsHiddenIsNamedOrTied) {
  const Json truth = sets().truths.at(GetParam());
  const subject::Subject s = read_mechanism(sets().own / "arm.yaml");
  const auto data = s.placed(measurement::read_measurements(sets().folder / (GetParam() + ".csv"), s.instruments()));
  std::vector<effects::Effect> all = test::all_effects();
  for (effects::Effect& e : effects::place_effects(s, all)) all.push_back(std::move(e));
  const diagnosis::Diagnosis d = diagnosis::diagnose(s, data, all, {{}, 199});
  std::vector<std::string> found;
  for (const effects::PlacedEffect& e : d.missing) found.push_back(e.effect->name);
  for (const auto& tie : d.indistinguishable) found.insert(found.end(), tie.begin(), tie.end());
  const std::string said =
      fmt::format("{}: {}", diagnosis::verdict_names[static_cast<int>(d.verdict)], fmt::join(found, ", "));
  const Json& hidden = truth.at("effects");
  if (truth.at("unknown").get<bool>()) {
    EXPECT_EQ(d.verdict, diagnosis::Verdict::unknown_effect) << said;
  } else if (hidden.empty()) {
    EXPECT_EQ(d.verdict, diagnosis::Verdict::nothing_missing) << said;
  } else {
    for (auto each = hidden.begin(); each != hidden.end(); ++each)
      EXPECT_NE(std::find(found.begin(), found.end(), each.key()), found.end()) << each.key() << " in " << said;
    EXPECT_EQ(d.missing.size(), hidden.size()) << said;
    expect_values(d, hidden);
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, ForeignArm, testing::ValuesIn(sets().names()),
                         [](const auto& set) { return test::test_name(set.param); });

}  // namespace
}  // namespace deflect
