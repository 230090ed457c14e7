// Effects that do not grow in proportion: play as wide as the motion, supports that yield until they are gone. What
// they do has another direction than while they are small, and another effect comes nearer to that at first.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "msa/frame/file/frame_file.h"
#include "tests/support/effects.h"
#include "tests/support/paths.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/diagnosis/interval.h"
#include "validation/effects/effect_file.h"
#include "validation/effects/place_effects.h"
#include "validation/effects/with_effect.h"
#include "validation/subject/simulate_frame.h"
#include "validation/subject/subject.h"

namespace deflect {
namespace {

struct Large {
  const char *frame, *effect, *campaign;
  double value;
};

class LargePlay : public testing::TestWithParam<Large> {};

TEST_P(LargePlay, IsNamedWithItsSize) {
  const Large& p = GetParam();
  const subject::Subject s = frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames" /
                                               (std::string(p.frame) + ".yaml"));
  std::vector<effects::Effect> all = test::all_effects();
  for (effects::Effect& e : effects::place_effects(s, all)) all.push_back(std::move(e));
  const effects::Effect& hidden = effects::find_effect(all, p.effect);
  const subject::Subject with = effects::with_effect(s, {{&hidden, {}}, VectorX::Constant(1, p.value)});
  const diagnosis::Diagnosis d = diagnosis::diagnose(
      s, subject::simulate_frame(*with.frame(), subject::frame_campaign(p.campaign, *s.frame(), 1), {}), all,
      {{}, 199});
  std::vector<std::string> named;
  for (const effects::PlacedEffect& e : d.missing) named.push_back(e.effect->name);
  EXPECT_EQ(named, std::vector<std::string>{p.effect}) << diagnosis::verdict_names[static_cast<int>(d.verdict)];
  ASSERT_EQ(d.fit.values.size(), 1);
  const auto [low, high] = diagnosis::interval95(d.missing, d.fit, 0);
  EXPECT_LE(low, p.value);
  EXPECT_GE(high, p.value);
}

INSTANTIATE_TEST_SUITE_P(Frames, LargePlay,
                         testing::Values(Large{"beam-on-springs", "clearance@spring.pad1.uz", "rich", 0.5},
                                         Large{"portal-semi-rigid", "clearance@supports.ry", "rich", 1e-3}),
                         [](const auto& each) {
                           std::string name = each.param.effect;
                           std::replace_if(
                               name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

}  // namespace
}  // namespace deflect
