// One gross outlier among fewer than twenty readings of a machine that also lacks an effect: it is set aside, and the
// effect is found.
#include <gtest/gtest.h>

#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"

namespace deflect {
namespace {

using namespace measurement;

constexpr std::size_t poses = 6;

/// 18 readings, three at each pose; the one in the middle along x is wrong by 25 standard deviations.
Measurements with_one_outlier(const Mechanism& m, const Mechanism& truth, std::uint64_t seed) {
  prediction::SimulationOptions o;
  o.seed = seed;
  Measurements plan = prediction::campaign("paper", m, 50, seed);
  std::erase_if(plan.readings, [](const Reading& r) { return r.pose >= poses; });
  plan.poses.resize(poses);
  Measurements out = prediction::simulate(truth, std::move(plan), o);
  Reading& wrong = out.readings[out.readings.size() / 2];
  *wrong.displacement[0] += 25 * o.sigma_u;
  return out;
}

TEST(Diagnose, SetsAsideOneOutlierOfFewReadingsBesideAnEffect) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  const Mechanism truth = with_effect(m, test::effect("guide_root_compliance"), test::values({5e6}));
  for (const std::uint64_t seed : {1, 2}) {
    SCOPED_TRACE(seed);
    const Measurements data = with_one_outlier(m, truth, seed);
    ASSERT_EQ(data.readings.size(), 3 * poses);
    diagnosis::DiagnosisOptions o;
    o.bootstrap_sets = 99;
    const diagnosis::Diagnosis d = diagnosis::diagnose(m, data, test::all_effects(), o, {1});
    EXPECT_EQ(d.set_aside, 1u);
    EXPECT_FALSE(d.unexplained);
    ASSERT_EQ(d.missing.size(), 1u);
    EXPECT_EQ(d.missing.front().effect->name, "guide_root_compliance");
  }
}

}  // namespace
}  // namespace deflect
