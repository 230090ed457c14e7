// The quick way of frames, by what is known of one near, against the analysis of each: random frames with any effect of
// any size.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "tests/attack/count.h"
#include "tests/attack/random_frame.h"
#include "tests/attack/random_pipeline.h"
#include "tests/support/effects_everywhere.h"
#include "validation/effects/with_effect.h"
#include "validation/subject/frame_readings.h"

namespace deflect::attack {
namespace {

constexpr int effects_each = 12;

VectorX by_lot(const effects::Effect& e, Dice& dice) {
  VectorX out(std::ssize(e.parameters));
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const effects::EffectParameter& p = nth(e.parameters, i);
    const double share = dice.real(0, 1);
    out(i) = p.low > 0 ? p.low * std::pow(p.high / p.low, share) : p.low + share * (p.high - p.low);
  }
  return out;
}

/// By quantity, the largest reading.
double largest_of(const std::vector<VectorX>& readings, const measurement::Measurements& data,
                  measurement::Quantity q) {
  double most = 0;
  for (const VectorX& r : readings)
    for (std::size_t k = 0; k < data.instruments.sensors.size(); ++k)
      if (data.instruments.sensors[k].quantity == q) most = std::max(most, std::abs(r(as_index(6 + k))));
  return most;
}

struct NearTable {
  int compared = 0;
  std::string failures;

  void judge(const Pipeline& p, const subject::FrameNearby& near, const effects::EffectInstance& hidden,
             const std::string& words) {
    const auto changed = outcome_of([&] { return effects::with_effect(p.subject, hidden); });
    if (!changed) return;
    const auto readings = [&](const subject::FrameNearby* known) {
      return outcome_of(
          [&] { return subject::predicted_readings(*changed->frame(), p.plan, Geometry::linear, known); });
    };
    const auto by_near = readings(&near), whole = readings(nullptr);
    // The analysis may give up where laws or digits are hard to find; what the quick way gives up is left to it.
    if (!by_near && whole) failures += fmt::format("seed {} {}: {}\n", p.seed, words, by_near.why);
    if (!by_near || !whole) return;
    ++compared;
    const std::vector<measurement::SensorChannel>& sensors = p.plan.instruments.sensors;
    for (std::size_t k = 0; k < sensors.size(); ++k) {
      const double size = std::max(largest_of(*whole, p.plan, sensors[k].quantity), 1e-12);
      double off = 0;
      for (std::size_t r = 0; r < whole->size(); ++r)
        off = std::max(off, std::abs((*by_near)[r](as_index(6 + k)) - (*whole)[r](as_index(6 + k))));
      if (off > 1e-6 * size)
        failures += fmt::format("seed {} {}: {} is {:.3g} of {:.3g} off\n", p.seed, words, sensors[k].name, off, size);
    }
  }
};

NearTable judged(unsigned first, unsigned last) {
  NearTable table;
  for (unsigned seed = first; seed < last; ++seed) {
    const auto p = random_pipeline(seed);
    if (!p || p->kind != PipelineKind::frame) continue;
    const subject::FrameNearby near(*p->subject.frame(), p->plan);
    const std::vector<effects::Effect> all = test::effects_everywhere(p->subject);
    Dice dice(seed);
    for (int i = 0; i < effects_each; ++i) {
      const effects::Effect& e = nth(all, dice.whole(0, static_cast<int>(all.size()) - 1));
      const effects::EffectInstance hidden{{&e, {}}, by_lot(e, dice)};
      table.judge(*p, near, hidden, fmt::format("{} {}", e.name, hidden.values.size() > 0 ? hidden.values(0) : 0));
    }
  }
  return table;
}

TEST(NearFrames, ReadWhatTheAnalysisReads) {
  const NearTable table = judged(0, 200);
  EXPECT_TRUE(table.failures.empty()) << table.failures;
  EXPECT_GT(table.compared, 200);
}

TEST(NearFramesOnDemand, ReadWhatTheAnalysisReads) {
  if (count_on_demand() == 0) GTEST_SKIP() << "set DEFLECT_ATTACK to the number of pipelines whose frames are taken";
  const NearTable table = judged(first_on_demand(), count_on_demand());
  fmt::print("{} frames with an effect compared\n", table.compared);
  EXPECT_TRUE(table.failures.empty()) << table.failures;
}

}  // namespace
}  // namespace deflect::attack
