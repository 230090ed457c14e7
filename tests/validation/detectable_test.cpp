// The smallest size of an effect that a campaign shows: its signature is four standard deviations long.
#include "validation/diagnosis/detectable.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"

namespace deflect::diagnosis {
namespace {

class DetectableSizes : public ::testing::Test {
 protected:
  static measurement::Measurements simulated(const Mechanism& m) {
    prediction::SimulationOptions o;
    o.tolerances = 0;
    return prediction::simulate(m, prediction::campaign("rich", m, 50, 1), o);
  }
  static std::vector<effects::Effect> entries() {
    std::vector<effects::Effect> out;
    for (const char* name : {"guide_root_compliance", "actuator_compliance", "platform_flexibility", "guide_diameter",
                             "base_compliance", "load_gain"})
      out.push_back(test::effect(name));
    return out;
  }
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  const measurement::Measurements data = simulated(m);
  const Observations o{subject::Subject(m), data, {}};
  const std::vector<effects::Effect> all = entries();
  const std::vector<Signature> signs = signatures(o, all, 1);
  const std::vector<Detectable> detectable = detectable_sizes(signs, cosines(signs, inner_products(signs)));
};

TEST_F(DetectableSizes, ChangeTheReadingsByFourDeviations) {
  std::size_t judged = 0;
  for (const Detectable& d : detectable) {
    if (d.effect.effect->parameters.size() != 1) continue;
    const std::string& name = d.effect.effect->name;
    ASSERT_EQ(d.smallest.size(), 1u) << name;
    const subject::Subject with = effects::with_effect(m, *d.effect.effect, test::values({d.smallest[0]}));
    // To the first order in the size.
    EXPECT_NEAR((o.whitened_residual(with) - o.null_residual()).norm(), 4, 0.5) << name;
    ++judged;
  }
  EXPECT_EQ(judged, 5u);
}

TEST_F(DetectableSizes, OfEveryParameterThatVanishes) {
  const auto base = std::find_if(detectable.begin(), detectable.end(),
                                 [](const auto& d) { return d.effect.effect->name == "base_compliance"; });
  ASSERT_NE(base, detectable.end());
  EXPECT_EQ(base->smallest.size(), base->effect.effect->parameters.size());
}

TEST_F(DetectableSizes, NameTheMostSimilarEntryFromACosineOfNineTenths) {
  ASSERT_EQ(detectable.size(), signs.size());
  std::size_t named = 0;
  for (std::size_t i = 0; i < signs.size(); ++i) {
    double most = 0;
    std::string other;
    for (std::size_t k = 0; k < signs.size(); ++k)
      if (const double c = cosine(signs[i], signs[k]); k != i && c > most)
        most = c, other = signs[k].effect.effect->name;
    EXPECT_NEAR(detectable[i].cosine, most, 1e-9);
    EXPECT_EQ(detectable[i].mistaken_for, most < 0.9 ? "" : other);
    named += most >= 0.9;
  }
  EXPECT_GT(named, 0u);
  EXPECT_LT(named, signs.size());
}

}  // namespace
}  // namespace deflect::diagnosis
