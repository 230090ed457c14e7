// A frame of which nobody tells the noise of one sensor, or of any: what is told counts, and what is missing is found.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "msa/frame/file/frame_file.h"
#include "tests/support/devices.h"
#include "tests/support/effects_everywhere.h"
#include "tests/support/paths.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/effects/with_effect.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"
#include "validation/subject/simulate_frame.h"

namespace deflect {
namespace {

using diagnosis::Diagnosis;
using subject::Subject;

/// The portal, σ told of so many of its sensors, the first ones.
frame::FrameDescription portal(std::size_t told) {
  frame::FrameDescription f =
      frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames/portal-semi-rigid.yaml");
  for (std::size_t k = told; k < f.sensors.size(); ++k) f.sensors[k].second.sigma = 0;
  return f;
}

constexpr std::size_t all = 6;

/// Fourteen loads by lot: none is repeated, so that no scatter of replicates tells the noise.
measurement::Measurements readings(double gap_mm) {
  const Subject drawn = portal(all);
  const std::vector<effects::Effect> everywhere = test::effects_everywhere(drawn);
  const effects::EffectInstance play{{&effects::find_effect(everywhere, "clearance@support.D.ux"), {}},
                                     VectorX::Constant(1, gap_mm)};
  measurement::Measurements plan = subject::frame_campaign("random", *drawn.frame(), 4);
  plan.readings.resize(14);
  plan.poses.front().readings.resize(14);
  return subject::simulate_frame(*effects::with_effect(drawn, play).frame(), plan, {});
}

/// As a file is read with the description that tells these σ.
measurement::Measurements as_read_with(std::size_t told, measurement::Measurements data) {
  for (std::size_t k = told; k < all; ++k) data.instruments.sensors[k].sigma.reset();
  return data;
}

TEST(UntoldNoise, WhatIsToldOfOthersStays) {
  const measurement::Measurements data = readings(0.05);
  for (const std::size_t told : {all, all - 1}) {
    const Subject s = portal(told);
    const measurement::Measurements as_read = as_read_with(told, data);
    const compare::Comparison c = compare::compare(s, as_read, {}, {1});
    for (std::size_t i = 0; i < c.sigma.size(); ++i) {
      const bool untold = c.study.values[i].channel >= 6 + told;
      EXPECT_EQ(c.estimated[i], untold);
      // The cell's own is 4 N; of 14 readings beside patterns about ten freedoms are left.
      EXPECT_NEAR(std::log(c.sigma[i] / (untold ? 4 : *c.study.values[i].sigma)), 0, untold ? 0.7 : 0);
    }
    EXPECT_FALSE(c.sigma_from_residuals);
  }
}

/// Play of many times the noise is named, whether or not the noise is told, and known about as well.
TEST(UntoldNoise, PlayIsFoundWithoutIt) {
  const measurement::Measurements data = readings(0.1);
  for (const std::size_t told : {all, all - 1, std::size_t{0}}) {
    const Subject s = portal(told);
    const std::vector<effects::Effect> everywhere = test::effects_everywhere(s);
    const Diagnosis d = diagnosis::diagnose(s, as_read_with(told, data), everywhere, {{}, 199}, {1});
    ASSERT_EQ(d.missing.size(), 1u) << told;
    EXPECT_EQ(d.missing.front().effect->name, "clearance@support.D.ux") << told;
    EXPECT_EQ(d.verdict, diagnosis::Verdict::effect) << told;
    EXPECT_NEAR(d.fit.values(0), 0.1, 0.03) << told;
  }
}

// One row of a campaign without σ is too little to read the scatter off, and one instrument read all of them.
TEST(UntoldNoise, AnEmptyCellTakesThatOfTheOtherRows) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  measurement::Measurements data = prediction::simulate(m, prediction::campaign("paper", m, 50, 1), {});
  for (std::size_t i = 0; i < data.readings.size(); ++i) data.readings[i].sigma_u = i % 2 == 0 ? 1e-6 : 3e-6;
  const std::size_t untold = 4;
  data.readings[untold].sigma_u.reset();
  const compare::Comparison c = compare::compare(Subject(m), data, {}, {1});
  const double even = 13, odd = 13;  // of the 26 others
  for (std::size_t i = 0; i < c.sigma.size(); ++i) {
    const std::size_t reading = c.study.values[i].reading;
    const double expected = reading == untold  ? std::sqrt((even * 1 + odd * 9) / 26) * 1e-6
                            : reading % 2 == 0 ? 1e-6
                                               : 3e-6;
    EXPECT_NEAR(c.sigma[i], expected, 1e-12 * expected) << i;
    EXPECT_EQ(c.estimated[i], reading == untold) << i;
  }
}

}  // namespace
}  // namespace deflect
