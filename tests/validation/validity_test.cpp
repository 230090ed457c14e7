// Validation in the words of the standards: its measures against hand calculations, its verdicts on a cantilever whose
// truth is known.
#include "validation/validity/validation.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/frame/file/frame_file.h"
#include "tests/support/cantilever.h"
#include "tests/support/devices.h"
#include "validation/measurement/random.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"
#include "validation/report/validity/validity_results.h"
#include "validation/validity/hull.h"

namespace deflect {
namespace {

using namespace validity;
using measurement::Measurements;
using subject::Subject;

// ∫|F_n(u) − u|: of one value ½ two triangles of 1/8; of one at an end the whole half square; of n values in the middle
// of n equal intervals 2n triangles of 1/(8 n²).
TEST(AreaMetric, IsTheAreaBetweenBothDistributionFunctions) {
  EXPECT_NEAR(area_from_uniform({0.5}), 0.25, 1e-15);
  EXPECT_NEAR(area_from_uniform({0}), 0.5, 1e-15);
  EXPECT_NEAR(area_from_uniform({1, 1, 1}), 0.5, 1e-15);
  for (const int n : {1, 2, 7, 100}) {
    std::vector<double> u;
    for (int i = 0; i < n; ++i) u.push_back((i + 0.5) / n);
    EXPECT_NEAR(area_from_uniform(u), 1 / (4.0 * n), 1e-14) << n;
  }
  // Of one value 0: twice ∫ Φ from −∞ to 0, φ(0). Far to one side: the distance.
  EXPECT_NEAR(area_from_normal({0}), 2 / std::sqrt(2 * std::numbers::pi), 1e-12);
  EXPECT_NEAR(area_from_normal({50, 50}), 50, 1e-9);
  EXPECT_NEAR(area_from_normal({-50}), 50, 1e-9);
}

// The mean of 2000 samples of n = 400 has a standard error of about a half of it over √2000; the formula is that of
// large n, short by O(1/n).
TEST(AreaMetric, OfUniformValuesIsWhatIsExpected) {
  measurement::Random random(3);
  constexpr int samples = 2000, n = 400;
  double sum = 0;
  for (int i = 0; i < samples; ++i) {
    std::vector<double> u;
    for (int k = 0; k < n; ++k) u.push_back(random.uniform(0, 1));
    sum += area_from_uniform(u);
  }
  EXPECT_NEAR(sum / samples / expected_area(n), 1, 4 * 0.5 / std::sqrt(samples) + 2.0 / n);
}

TEST(Bias, FactorAndScatterAreThoseOfTheLogarithms) {
  std::vector<Pair> exact;
  for (double D = 1; D < 20; ++D) exact.push_back({1.1 * D, D, 1e-6});
  ASSERT_TRUE(bias_of(exact));
  EXPECT_NEAR(bias_of(exact)->factor, 1.1, 1e-9);
  EXPECT_TRUE(bias_of(exact)->scatter_from_experiment);
  // ln S/D ~ N(ln 1.1 − σ_M²/2 + σ_E²/2, σ_M² + σ_E²) with σ_M = 0.05, σ_E = 0.02: known to 1/√2n of itself.
  measurement::Random random(5);
  std::vector<Pair> pairs;
  constexpr int n = 4000;
  for (int i = 0; i < n; ++i) {
    const double truth = random.uniform(1, 10), D = truth * (1 + 0.02 * random.normal());
    pairs.push_back({1.1 * truth * (1 + 0.05 * random.normal()), D, 0.02 * D});
  }
  const Bias b = *bias_of(pairs);
  EXPECT_NEAR(b.factor, 1.1, 4 * 1.1 * 0.054 / std::sqrt(n));
  EXPECT_NEAR(b.scatter, 0.05, 4 * 0.054 / std::sqrt(2 * n) + 1e-3);
  EXPECT_NEAR(b.experiment, 0.02, 1e-12);
  EXPECT_EQ(b.pairs, pairs.size());
  EXPECT_FALSE(bias_of({{1, 1, 0}, {1, 1, 0}}));
  EXPECT_FALSE(bias_of({{1, -1, 0}, {1, -1, 0}, {1, -2, 0}, {1, 1, 1}}));
}

// p is nearest to q if and only if no column lies beyond the plane through p across q − p.
TEST(Hull, NearestPointFulfilsItsCondition) {
  MatrixX square(2, 4);
  square << 0, 1, 0, 1, 0, 0, 1, 1;
  EXPECT_NEAR((nearest_in_hull(square, Vector3(0.2, 0.7, 0).head<2>()) - Vector3(0.2, 0.7, 0).head<2>()).norm(), 0,
              1e-8);
  EXPECT_NEAR((nearest_in_hull(square, Vector3(3, 0.5, 0).head<2>()) - Vector3(1, 0.5, 0).head<2>()).norm(), 0, 1e-7);
  EXPECT_NEAR((nearest_in_hull(square, Vector3(-1, 4, 0).head<2>()) - Vector3(0, 1, 0).head<2>()).norm(), 0, 1e-7);
  std::mt19937 random(7);
  for (int trial = 0; trial < 200; ++trial) {
    const int rows = 1 + trial % 4, columns = 1 + trial % 23;
    MatrixX X(rows, columns);
    VectorX q(rows);
    for (double& x : X.reshaped()) x = test::uniform(random, -1, 1);
    for (double& x : q) x = test::uniform(random, -2, 2);
    const VectorX p = nearest_in_hull(X, q), away = q - p;
    EXPECT_LE(((X.colwise() - p).transpose() * away).maxCoeff(), 1e-6) << trial;
  }
}

using test::cantilever::tip;

constexpr double sigma = 10e-6;

Subject beam() {
  return frame::parse_frame(
      test::cantilever::file(
          "sensors: {z: {node: B, direction: uz, sigma: 10 um}}\ntolerances: {modulus: 1 %, load: 0.5 %}\n"),
      "frame.yaml");
}

/// Readings of the tip; `read(factor, session)` in m.
Measurements read(const std::function<double(double, int)>& tip_of, std::uint64_t seed = 0,
                  const std::string& name = "data.csv") {
  measurement::Random random(seed);
  std::string csv = "load.tip,z_mm,note_session\n";
  for (int session = 1; session <= 3; ++session)
    for (const double f : {1.0, -1.0, 0.5, -0.5, 0.75, -0.75, 0.25, -0.25})
      csv += fmt::format("{},{:.9f},day {}\n", f, 1e3 * (tip_of(f, session) + (seed ? sigma * random.normal() : 0)),
                         session);
  return beam().placed(measurement::parse_measurements(csv, name, beam().instruments()));
}
double right(double factor, int) { return -factor * tip; }

ValidationOptions as_recorded() {
  ValidationOptions o;
  o.comparison.as_recorded = true;
  return o;
}

// u_input: 1 % of E makes 1 %/1.01 of the deflection; the load cell 0.5 %; noise is the sensor's.
TEST(Validity, UncertaintiesAreThoseOfHand) {
  const Measurements data = read([](double f, int) { return -f * tip + 3e-6; });
  const ValidationStudy s = validate(beam(), data, as_recorded());
  ASSERT_EQ(s.errors.size(), 24u);
  const ComparisonError& e = s.errors.front();
  EXPECT_NEAR(e.E(), -3e-6, 1e-11);
  EXPECT_NEAR(e.input, 0.01 * tip / 1.01, 1e-6 * tip);
  EXPECT_NEAR(e.load, 0.005 * tip, 1e-9 * tip);
  EXPECT_EQ(e.noise, sigma);
  EXPECT_LT(e.num, 1e-9 * tip);  // an element is exact at its ends
  EXPECT_NEAR(e.u_val(), std::sqrt(e.input * e.input + e.load * e.load + sigma * sigma), 1e-15);
  ASSERT_EQ(s.channels.size(), 1u);
  EXPECT_NEAR(s.channels[0].mean_E, -3e-6, 1e-11);
  EXPECT_EQ(s.channels[0].within, 1);
  EXPECT_TRUE(agrees(s.agreement));
  EXPECT_EQ(s.agreement.numbers, 24u);
}

/// A tip that moves by a tenth of the length: what one element leaves out is what 32 elements tell, to a tenth. Under a
/// force at the tip the error falls with the fourth power of the length of elements, under a line load with the second,
/// and also where the beam is twisted while it bends, in space.
TEST(Validity, InTheDeformedShapeTheNumericalUncertaintyIsThatOfTheElements) {
  const auto with = [](const std::string& elements) {
    std::string text =
        test::cantilever::file("geometry: finite\nsensors: {z: {node: B, direction: uz, sigma: 10 um}}\n",
                               "line: {members: {beam: {qz: -25 N/m, axes: base}}}, "
                               "twist: {nodes: {B: {fz: -10 N, mx: 2 Nm}}}");
    text.erase(text.find("plane: xz"), 9);
    const std::string end = "y_axis: [0, 1, 0]";
    return Subject(frame::parse_frame(text.replace(text.find(end), end.size(), end + ", elements: " + elements), "f"));
  };
  const Subject coarse = with("1"), fine = with("32");
  using Case = std::tuple<std::string, int, std::string>;
  // The order is taken where differences are far above rounding and terms of higher order far below them.
  for (const auto& [load, order, elements] :
       {Case{"load.tip", 4, "2"}, Case{"load.line", 2, "4"}, Case{"load.twist", 2, "16"}}) {
    SCOPED_TRACE(load);
    const Measurements data = coarse.placed(
        measurement::parse_measurements(load + ",z_mm\n100,-118\n-100,118\n", "data.csv", coarse.instruments()));
    const ValidationStudy one = validate(coarse, data, as_recorded()), many = validate(fine, data, as_recorded());
    const double error = std::abs(one.errors.front().S - many.errors.front().S);
    EXPECT_GT(error, 1e-6 * tip);
    EXPECT_NEAR(one.errors.front().num, 1.25 / 1.15 * error, 0.1 * error);
    const std::vector<MeshOrder> mesh = validate(with(elements), data, as_recorded()).mesh;
    ASSERT_EQ(mesh.size(), 1u);
    ASSERT_TRUE(mesh.front().order);
    EXPECT_NEAR(*mesh.front().order, order, 0.1);
    // A factor of two for the two estimates; Newton's method ends at some 1e-9 of the tip's motion.
    EXPECT_LT(many.errors.front().num, 2 * one.errors.front().num / std::pow(32, order) + 1e-9 * 100 * tip);
  }
}

/// A stiffness 20 % off is beyond 1 % of tolerance: each reading errs by 1/1.2 − 1 of itself, and so does the bias.
TEST(Validity, AWrongStiffnessIsBeyondTheUncertaintyAndItsBiasIsTold) {
  const Measurements data = read([](double f, int) { return -f * tip * 1.2; }, 4);
  const ValidationStudy s = validate(beam(), data, as_recorded());
  EXPECT_FALSE(agrees(s.agreement));
  ASSERT_TRUE(s.channels[0].bias);
  EXPECT_NEAR(s.channels[0].bias->factor, 1 / 1.2, 0.01);
  ASSERT_EQ(s.discrepancies.size(), 1u);
  // E² − u_val² against S²: 0.2² less the tolerance's 0.01² and noise.
  EXPECT_NEAR(s.discrepancies[0].share, 0.2, 0.01);
  // As many readings lie far above their prediction as far below, so that the pooled distribution function is ½ between
  // 0 and 1: the area beside the diagonal is ∫|½ − u| du.
  EXPECT_NEAR(s.area, 0.25, 1e-3);
  EXPECT_GT(s.area, 3 * s.expected_area);
  EXPECT_TRUE(report::validity_words(s).starts_with("The model is in error at these readings: a right model"));
}

// A gross error in one session alone: the verdict hangs on it, and on no other group.
TEST(Validity, TellsOnWhichGroupTheVerdictHangs) {
  const Measurements data =
      read([](double f, int session) { return -f * tip + (session == 2 ? 35e-6 * (f > 0 ? 1 : -1) : 0); }, 9);
  const ValidationStudy s = validate(beam(), data, as_recorded());
  ASSERT_FALSE(agrees(s.agreement));
  for (const WithoutGroup& w : s.without)
    EXPECT_EQ(w.changes, w.kind == "session" && w.name == "day 2") << w.kind << w.name;
}

TEST(Validity, CalibrationDataAreKeptApart) {
  const Measurements data = read(right, 1), same = read(right, 1, "again.csv"), other = read(right, 2, "other.csv");
  ValidationOptions o = as_recorded();
  o.calibration = &same;
  const auto refused = outcome_of<InputError>([&] { return validate(beam(), data, o); });
  EXPECT_NE(refused.why.find("again.csv:2: the same reading stands in data.csv:2"), std::string::npos) << refused.why;
  o.calibration = &other;
  const ValidationStudy s = validate(beam(), data, o);
  ASSERT_TRUE(s.calibration);
  EXPECT_EQ(s.calibration->readings, 24u);
  EXPECT_NEAR(s.calibration->rms_E, sigma, 0.6 * sigma);
}

// Zeros at no load are equal in any two files.
TEST(Validity, ReadingsWithoutLoadMayBeEqual) {
  const auto with_zero = [](const char* rows, const char* name) {
    return beam().placed(
        measurement::parse_measurements("load.tip,z_mm\n0,0\n" + std::string(rows), name, beam().instruments()));
  };
  const Measurements data = with_zero("1,-1.19\n-1,1.191\n", "data.csv"), other = with_zero("1,-1.192\n", "other.csv");
  ValidationOptions o = as_recorded();
  o.calibration = &other;
  EXPECT_EQ(validate(beam(), data, o).calibration->readings, 2u);
}

// A factor on a load case is no force: of two readings with both, one is mostly the case, one mostly the force.
TEST(Validity, LoadsOfOneKindAreComparedWithEachOther) {
  const Measurements data = beam().placed(measurement::parse_measurements(
      "load.tip,node.B.fx_N,z_mm\n1,1,-1.19\n0.1,50,-0.119\n", "data.csv", beam().instruments()));
  const ValidationStudy s = validate(beam(), data, as_recorded());
  std::vector<std::string> directions;
  for (const WithoutGroup& w : s.without)
    if (w.kind == "load direction") directions.push_back(w.name);
  EXPECT_EQ(directions, (std::vector<std::string>{"load.tip > 0", "node.B.fx > 0"}));
}

TEST(Validity, SaysHowFarAUseIsFromWhatWasValidated) {
  const Measurements data = read(right, 1);
  const Measurements use = beam().placed(
      measurement::parse_measurements("load.tip,z_mm\n0.9,0\n3,0\n-1,0\n", "use.csv", beam().instruments()));
  ValidationOptions o = as_recorded();
  o.use = &use;
  const ValidationStudy s = validate(beam(), data, o);
  ASSERT_TRUE(s.use);
  ASSERT_EQ(s.use->points.size(), 3u);
  EXPECT_TRUE(s.use->points[0].inside());
  EXPECT_TRUE(s.use->points[2].inside());
  EXPECT_NEAR(s.use->points[1].load_distance, 2, 1e-6);
  ASSERT_EQ(s.domain.size(), 1u);
  EXPECT_EQ(s.domain[0].name, "load.tip");
  EXPECT_TRUE(s.domain[0].outside());
  EXPECT_NEAR(s.use->predicted.numbers[1].value, -3 * tip, 1e-9);
}

// A support that yields more under large loads: its stiffness is not the same at every load size. p is uniform where it
// is the same, so that it is below 1e-3 once in a thousand seeds.
TEST(Validity, TellsWhetherAParameterIsTheSameEverywhere) {
  ValidationOptions o = as_recorded();
  o.parameters = fit::free_parameters(beam(), {"materials.steel.E"}, {});
  const auto p_of = [&](const ValidationStudy& s, const std::string& kind) {
    for (const Sameness& each : s.same)
      if (each.kind == kind) return each.p_value;
    return -1.0;
  };
  const Measurements alike = read(right, 11),
                     bent = read([](double f, int) { return -f * tip * (1 + 0.2 * f * f); }, 12),
                     drifted = read([](double f, int session) { return -f * tip * (1 + 0.1 * session); }, 13);
  const ValidationStudy same = validate(beam(), alike, o);
  EXPECT_GT(p_of(same, "load size"), 1e-3);
  EXPECT_GT(p_of(same, "session"), 1e-3);
  EXPECT_LT(p_of(validate(beam(), bent, o), "load size"), 1e-6);
  EXPECT_LT(p_of(validate(beam(), drifted, o), "session"), 1e-6);
}

// Healthy machines within all their tolerances are rejected as often as the test says. Of 40 at 5 %: eight or more
// happen once in a thousand times.
TEST(Validity, AHealthyMachineAgrees) {
  const Mechanism m = test::device("arm");
  int rejected = 0;
  constexpr int n = 12;
  for (std::uint64_t seed = 1; seed <= n; ++seed) {
    prediction::SimulationOptions o;
    o.seed = seed;
    const Measurements data = prediction::simulate(m, prediction::campaign("paper", m, 50, seed), o);
    const ValidationStudy s = validate(m, data, as_recorded(), parallel::alone);
    rejected += !agrees(s.agreement);
    EXPECT_EQ(s.theories, 2u);
    for (const ChannelValidity& c : s.channels) EXPECT_LT(c.num, 1e-3 * c.val) << c.name;
  }
  EXPECT_LE(rejected, 4);  // of 12 at 5 %: five or more once in 5000 times
}

}  // namespace
}  // namespace deflect
