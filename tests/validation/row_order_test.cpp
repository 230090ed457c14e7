// What is said of measurements depends neither on the order of their rows nor on what their poses are called.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "validation/compare/comparison.h"
#include "validation/effects/with_effect.h"
#include "validation/measurement/configure_all.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/prediction.h"
#include "validation/prediction/simulate.h"

namespace deflect {
namespace {

using namespace compare;
using namespace measurement;
using namespace prediction;

/// The same readings, rows and labels the other way round: every fifth row first, then the next ones.
Measurements rearranged(Measurements data) {
  for (std::size_t p = 0; p < data.poses.size(); ++p)
    data.poses[p].label = "approach " + std::to_string(data.poses.size() - p);
  std::istringstream text(measurements_text(data));
  std::string header, line;
  std::getline(text, header);
  std::vector<std::string> rows;
  while (std::getline(text, line)) rows.push_back(line);
  std::string out = header + "\n";
  for (std::size_t first = 0; first < 5; ++first)
    for (std::size_t i = first; i < rows.size(); i += 5) out += rows[rows.size() - 1 - i] + "\n";
  return parse_measurements(out, "rearranged");
}

TEST(Compare, TheOrderOfRowsAndTheNamesOfPosesDoNotMatter) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  Mechanism softer = m;
  softer.load_cell.gain = 1.05;  // something to be found
  SimulationOptions o;
  o.geometry = Geometry::linear;
  o.division = {};
  const Measurements data = simulate(softer, campaign("paper", m, 50, 1), o);
  const Comparison a = compare::compare(m, data), b = compare::compare(m, rearranged(data));
  // Sums of a hundred numbers in another order, weighed by deviations up to some dozens apart.
  const auto same = [](double x, double y) { EXPECT_NEAR(x, y, 1e-10 * std::abs(x)); };
  same(a.chi2_per_dof, b.chi2_per_dof);
  same(a.held_out, b.held_out);  // nine poses: a fold each
  same(a.unexplained_chi2_per_dof, b.unexplained_chi2_per_dof);
  same(a.noise_and_tolerances, b.noise_and_tolerances);
  ASSERT_EQ(a.patterns.size(), b.patterns.size());
  for (std::size_t i = 0; i < a.patterns.size(); ++i) same(a.patterns[i].alone.gain, b.patterns[i].alone.gain);
  ASSERT_EQ(a.contrasts.size(), b.contrasts.size());
  for (std::size_t i = 0; i < a.contrasts.size(); ++i) {
    EXPECT_EQ(a.contrasts[i].contrasts, b.contrasts[i].contrasts) << a.contrasts[i].id;
    EXPECT_NEAR(a.contrasts[i].p_value, b.contrasts[i].p_value, 1e-9) << a.contrasts[i].id;
  }
  ASSERT_EQ(a.findings.size(), b.findings.size());
  for (std::size_t i = 0; i < a.findings.size(); ++i) EXPECT_EQ(a.findings[i].pattern, b.findings[i].pattern);
}

// Where friction remembers, the readings of a pose follow their sequence, whatever the order of their rows.
TEST(Predict, FollowsTheSequenceAndNotTheRows) {
  const Mechanism drawn = test::device("haptic-6psu-ideal-joints");
  const Mechanism m = effects::with_effect(drawn, {{&test::effect("joint_friction"), {}}, test::values({5, 1e4, 1})});
  const Measurements data = simulate(drawn, campaign("cycle", drawn, 50, 1), {});
  const Measurements other = rearranged(data);
  PredictionOptions o;
  o.geometry = Geometry::linear;
  const std::vector<VectorX> a = predict(m, configure_all(m, data), data, o),
                             b = predict(m, configure_all(m, other), other, o);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_GT((a[0] - a[6]).norm(), 0.01 * a[0].norm()) << "under the same load, before and after a larger one";
  for (std::size_t i = 0; i < b.size(); ++i) {
    const VectorX& same = a[static_cast<std::size_t>(*other.readings[i].sequence)];
    EXPECT_LE((b[i] - same).norm(), 1e-12 * same.norm() + 1e-18) << *other.readings[i].sequence;
  }
}

}  // namespace
}  // namespace deflect
