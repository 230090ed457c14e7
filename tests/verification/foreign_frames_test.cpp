// Measurement sets of frames made by foreign_frames.py, foreign_alike.py and foreign_soft.py, which share nothing with
// deflect: what is hidden in each is found, or tied with what these sensors cannot tell from it. Some are in
// tests/verification/foreign_frames; DEFLECT_FOREIGN_FRAMES names a folder with others, as the programs write them.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "msa/frame/file/frame_file.h"
#include "tests/support/effects.h"
#include "tests/support/paths.h"
#include "tests/verification/foreign_sets.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/effects/place_effects.h"
#include "validation/subject/subject.h"

namespace deflect {
namespace {

const test::ForeignSets& sets() {
  static const test::ForeignSets all("foreign_frames", "DEFLECT_FOREIGN_FRAMES");
  return all;
}

/// What the diagnosis says is missing, and all that it ties with that.
std::vector<std::string> named(const diagnosis::Diagnosis& d) {
  std::vector<std::string> out;
  for (const effects::PlacedEffect& e : d.missing) out.push_back(e.effect->name);
  for (const auto& tie : d.indistinguishable) out.insert(out.end(), tie.begin(), tie.end());
  return out;
}

/// The names in "elsewhere@LOAD/DECLARED/TRUE" and "recording@CHANNEL+CHANNEL".
std::vector<std::string> parts_of(const std::string& effect) {
  std::vector<std::string> out = {""};
  for (const char c : effect.substr(effect.find('@') + 1))
    if (c == '/' || c == '+')
      out.emplace_back();
    else
      out.back() += c;
  return out;
}

/// What looks alike and is to be told apart: a sensor that sticks from a support or spring that rubs, play from a free
/// direction that is restrained.
bool is_the_other(const std::string& hidden, const std::string& named) {
  for (const auto& [a, b] : {std::pair{"stiction@", "friction@"}, {"clearance@", "restraint@"}})
    if ((hidden.starts_with(a) && named.starts_with(b)) || (hidden.starts_with(b) && named.starts_with(a))) return true;
  return false;
}

class ForeignFrame : public testing::TestWithParam<std::string> {};

TEST_P(ForeignFrame, WhatIsHiddenIsNamedOrTied) {
  const Json truth = sets().truths.at(GetParam());
  const subject::Subject s = frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames" /
                                               (truth.at("frame").get<std::string>() + ".yaml"));
  const auto data = s.placed(measurement::read_measurements(sets().folder / GetParam(), s.instruments()));
  std::vector<effects::Effect> all = test::all_effects();
  for (effects::Effect& e : effects::place_effects(s, all)) all.push_back(std::move(e));
  const diagnosis::Diagnosis d = diagnosis::diagnose(s, data, all, {{}, 199});
  const std::vector<std::string> found = named(d);
  const std::string said = fmt::format("{}: {}{}", diagnosis::verdict_names[static_cast<int>(d.verdict)],
                                       fmt::join(found, ", "), d.mistakes.empty() ? "" : d.mistakes.front().sentence);
  if (truth.at("effect").is_null()) {
    EXPECT_EQ(d.verdict, diagnosis::Verdict::nothing_missing) << said;
    return;
  }
  if (truth.value("unknown", false)) {
    // No part of the frame can do it: then no effect is named for it, least of all what only looks like it, and the
    // node is told.
    EXPECT_EQ(d.verdict, diagnosis::Verdict::unknown_effect) << said;
    for (const std::string& each : found)
      EXPECT_FALSE(is_the_other(truth.at("effect").get<std::string>(), each)) << said;
    const std::string rubs = "friction@";
    EXPECT_TRUE(std::any_of(d.localised.begin(), d.localised.end(), [&](const diagnosis::Localised& l) {
      return rubs + subject::id_of(l.place) == truth.at("effect");
    })) << said;
    return;
  }
  auto right = truth.at("acceptable").get<std::vector<std::string>>();
  right.push_back(truth.at("effect").get<std::string>());
  const bool names_it = std::any_of(right.begin(), right.end(), [&](const std::string& each) {
    return std::find(found.begin(), found.end(), each) != found.end();
  });
  if (!truth.contains("mistake") || names_it) {
    EXPECT_TRUE(names_it) << said;
    for (const std::string& each : found)
      EXPECT_FALSE(is_the_other(truth.at("effect").get<std::string>(), each)) << said;
    return;
  }
  ASSERT_TRUE(diagnosis::is_mistaken(d)) << said;
  for (const std::string& part : parts_of(truth.at("effect").get<std::string>()))
    EXPECT_NE(d.mistakes.front().sentence.find(part), std::string::npos) << said;
}

INSTANTIATE_TEST_SUITE_P(Sets, ForeignFrame, testing::ValuesIn(sets().names()),
                         [](const auto& set) { return test::test_name(set.param); });

}  // namespace
}  // namespace deflect
