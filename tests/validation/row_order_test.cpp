// What is said of measurements depends neither on the order of their rows nor on what their poses are called.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tests/support/devices.h"
#include "validation/compare/comparison.h"
#include "validation/prediction/campaign.h"
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

}  // namespace
}  // namespace deflect
