// A drift of the sensor by the rank of a reading in the sequence, whatever the order of the rows.
#include <gtest/gtest.h>

#include "tests/support/devices.h"
#include "validation/compare/comparison.h"
#include "validation/compare/patterns.h"
#include "validation/measurement/configure_all.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/prediction.h"
#include "validation/prediction/simulate.h"

namespace deflect {
namespace {

using namespace measurement;

const std::string device_name = "haptic-6psu-ideal-joints";

/// 81 readings whose sequence runs against the rows, in steps of 10.
Measurements backwards(const Mechanism& m) {
  Measurements data = prediction::campaign("paper", m, 50, 1);
  for (std::size_t i = 0; i < data.readings.size(); ++i)
    data.readings[i].sequence = 10 * static_cast<double>(data.readings.size() - i);
  return data;
}

TEST(Drift, GrowsFromNothingWithTheRank) {
  Mechanism m = test::device(device_name);
  const Measurements data = backwards(m);
  const std::vector<Configuration> configurations = configure_all(m, data);
  const std::vector<VectorX> still = prediction::predict(m, configurations, data);
  m.sensor.drift = Vector3(1e-3, -2e-3, 5e-4);
  const std::vector<VectorX> drifting = prediction::predict(m, configurations, data);
  const auto n = still.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double rank = static_cast<double>(n - 1 - i);
    const Vector3 drifted = (drifting[i] - still[i]).head<3>();
    EXPECT_LT((drifted - m.sensor.drift * (rank / static_cast<double>(n))).norm(), 1e-12 * m.sensor.drift.norm()) << i;
    EXPECT_EQ((drifting[i] - still[i]).tail(still[i].size() - 3).norm(), 0) << i;
  }
}

// Its pattern among residuals is a drift of 1 over N steps, about its middle: no constant offset hides in it.
TEST(Drift, PatternIsAboutTheMiddleOfTheSequence) {
  const Mechanism m = test::device(device_name);
  Measurements data = prediction::simulate(m, backwards(m), {});
  const compare::Comparison c = compare::compare(subject::Subject(m), data);
  for (const compare::Pattern& p : compare::patterns_of(c.study)) {
    if (p.id != compare::PatternId::drift) continue;
    const auto n = static_cast<double>(data.readings.size());
    ASSERT_EQ(p.rows.rows(), 3 * std::ssize(data.readings));
    ASSERT_EQ(p.rows.cols(), 3);
    for (Eigen::Index k = 0; k < 3; ++k) {
      EXPECT_NEAR(p.rows.col(k).sum(), 0, 1e-12 * n);
      EXPECT_NEAR(p.rows(k, k), (n - 0.5) / n - 0.5, 1e-12) << "the first row was read last";
      EXPECT_NEAR(p.rows(p.rows.rows() - 3 + k, k), 0.5 / n - 0.5, 1e-12) << "the last row was read first";
    }
    return;
  }
  FAIL() << "no pattern of drift";
}

}  // namespace
}  // namespace deflect
