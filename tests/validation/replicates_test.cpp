#include "validation/measurement/replicates.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/measurements.h"

namespace deflect {
namespace {

using namespace measurement;

using Groups = std::vector<std::vector<std::size_t>>;

const std::string header = "pose,q1_rad,fx_N,fy_N,fz_N,ux_mm,thx_rad";

Measurements of(const std::string& rows, const std::string& more = "") {
  return parse_measurements(header + more + "\n" + rows, "data.csv");
}

TEST(Replicates, ShareLabelAndLoad) {
  const Measurements m =
      of("a,1,10,0,0,1,\n"
         "a,1,-10,0,0,1,\n"
         "b,1,10,0,0,1,\n"
         "b,1,10.000,-0,0,1,\n"
         "a,1,1e1,0,0,1,\n"
         "a,1,10,0,0.001,1,\n"
         "a,1,10.00000000001,0,0,1,\n");
  EXPECT_EQ(replicates(m), (Groups{{0, 4, 6}, {2, 3}}));
}

TEST(Replicates, AreReachedInTheSameDirection) {
  const Measurements m =
      of("a,1,10,0,0,1,,0\n"  // from no load, up
         "a,1,20,0,0,1,,1\n"
         "a,1,10,0,0,1,,2\n"  // down
         "a,1,0,0,0,1,,3\n"   // down to zero
         "b,1,10,0,0,1,,4\n"
         "a,1,10,0,0,1,,6\n"  // from another pose: up
         "a,1,-10,0,0,1,,7\n"
         "a,1,0,0,0,1,,8\n"      // up to zero
         "a,1,20,0,0,1,,5.5\n",  // from b, before the one above: up
         ",sequence");
  EXPECT_EQ(replicates(m), (Groups{{1, 8}, {2, 5}}));
  EXPECT_EQ(replicates(m, Reached::in_any_direction), (Groups{{0, 2, 5}, {1, 8}, {3, 7}}));
}

// Loaded in steps, each read twice: the second reading of a step was reached as the first was, so that those on the way
// up and those on the way down are two groups.
TEST(Replicates, AStepThatIsReadAgainWasReachedOnce) {
  const Measurements m =
      of("a,1,10,0,0,1,,0\n"
         "a,1,10,0,0,1,,1\n"
         "a,1,20,0,0,1,,2\n"
         "a,1,20,0,0,1,,3\n"
         "a,1,20,0,0,1,,4\n"
         "a,1,10,0,0,1,,5\n"
         "a,1,10,0,0,1,,6\n"
         "b,1,10,0,0,1,,7\n"
         "a,1,10,0,0,1,,8\n",  // up from no load
         ",sequence");
  EXPECT_EQ(replicates(m), (Groups{{0, 1, 8}, {2, 3, 4}, {5, 6}}));
}

TEST(Replicates, PooledVarianceByHand) {
  // ux: {1, 2, 3} about 2 and {5, 9} about 7 give (1 + 0 + 1 + 4 + 4) / (2 + 1); thx: {1, 2} give 0.5 / 1.
  const Measurements m =
      of("a,1,10,0,0,1,\n"
         "a,1,10,0,0,2,1\n"
         "a,1,10,0,0,3,2\n"
         "b,1,10,0,0,5,\n"
         "b,1,10,0,0,9,7\n"
         "c,1,10,0,0,100,100\n");
  const PureError e = pure_error(m);
  ASSERT_TRUE(e.u && e.th);
  EXPECT_NEAR(e.u->sigma, 1e-3 * std::sqrt(10.0 / 3), 1e-15);
  EXPECT_EQ(e.u->degrees_of_freedom, 3u);
  EXPECT_NEAR(e.th->sigma, std::sqrt(0.5), 1e-15);
  EXPECT_EQ(e.th->degrees_of_freedom, 1u);
}

TEST(Replicates, WithoutThemTheNoiseIsNotKnown) {
  const Measurements none = of("a,1,10,0,0,1,1\nb,1,10,0,0,1,1\n");
  EXPECT_FALSE(pure_error(none).u);
  EXPECT_FALSE(pure_error(none).th);
  for (const MeasuredValue& v : measured_values(none)) EXPECT_FALSE(v.sigma);
  const Measurements alike = of("a,1,10,0,0,0.1,\na,1,10,0,0,0.1,\na,1,10,0,0,0.1,\n");
  EXPECT_FALSE(pure_error(alike).u) << "zero would weigh infinitely";
}

TEST(Replicates, MeasuredValuesCarryTheirStandardDeviation) {
  const Measurements m =
      of("a,1,10,0,0,1,4,0.5\n"
         "a,1,10,0,0,,2,\n"
         "a,1,20,0,0,3,,\n"
         "a,1,20,0,0,5,,0.25\n",
         ",sigma_u_mm");
  const std::vector<MeasuredValue> values = measured_values(m);
  const struct {
    std::size_t reading, component;
    double value, sigma;
  } expected[] = {
      {0, 0, 1e-3, 0.5e-3},                 // from the file
      {0, 3, 4, std::sqrt(2.0)},            // from 4 and 2
      {1, 3, 2, std::sqrt(2.0)},            //
      {2, 0, 3e-3, 1e-3 * std::sqrt(2.0)},  // from 3 and 5
      {3, 0, 5e-3, 0.25e-3},
  };
  ASSERT_EQ(values.size(), std::size(expected));
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(values[i].reading, expected[i].reading);
    EXPECT_EQ(values[i].channel, expected[i].component);
    EXPECT_EQ(values[i].value, expected[i].value);
    EXPECT_NEAR(values[i].sigma.value(), expected[i].sigma, 1e-15);
  }
}

}  // namespace
}  // namespace deflect
