// Each load of a reading has an error of its own: against two springs by hand.
#include "validation/statistics/load_errors.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "msa/frame/file/frame_file.h"
#include "tests/support/devices.h"
#include "validation/compare/comparison.h"
#include "validation/fit/predicted.h"
#include "validation/measurement/configure_all.h"
#include "validation/measurement/random.h"
#include "validation/prediction/simulate.h"
#include "validation/statistics/uncertainty.h"
#include "validation/subject/simulate_frame.h"

namespace deflect {
namespace {

using namespace measurement;
using statistics::LoadErrors;
using subject::Subject;

constexpr double t = 0.01, k1 = 168e6, k2 = 84e6, sigma = 1e-8;  // N/m, m

/// A spring k1 to the ground and behind it a bar k2 = EA/L, drawn at A and B along x.
std::string springs(const std::string& beside = "") {
  return R"(
name: springs
plane: xz
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {bar: {shape: rectangle, width_y: 20 mm, height_z: 20 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [1 m, 0 m, 0 m]}
members: {bar: {from: A, to: B, section: bar, material: steel, y_axis: [0, 1, 0]}}
supports: {A: {holds: [uz, ry])" +
         beside + R"(}}
springs: {ground: {node: A, ux: 168000 N/mm}}
loads: {near: {nodes: {A: {fx: 1 kN}}}, far: {nodes: {B: {fx: 1 kN}}}}
sensors:
  a: {node: A, direction: ux, sigma: 0.01 um}
  b: {node: B, direction: ux, sigma: 0.01 um}
  z: {node: B, direction: uz, sigma: 0.01 um}
tolerances: {load: 1 %}
)";
}

Subject frame_of(const std::string& yaml = springs()) { return frame::parse_frame(yaml, "frame.yaml"); }

Measurements read(const Subject& s, const std::string& csv) {
  return s.placed(parse_measurements(csv, "data.csv", s.instruments()));
}

LoadErrors errors_of(const Subject& s, const Measurements& data) {
  const auto standing = s.stand(data);
  return {s, *standing, data, standing->predict(data)};
}

/// A and B move by (a + b)/k1 and (a + b)/k1 + b/k2 under a and b, kN.
MatrixX by_hand(double a, double b) {
  MatrixX out(2, 2);
  out << a / k1, b / k1, a / k1, b / k1 + b / k2;
  return 1e3 * t * out;
}

TEST(LoadErrors, EachLoadOfARowMovesWhatItMovesAlone) {
  const Subject s = frame_of();
  const Measurements data = read(s, "load.near,load.far,a_mm,b_mm\n3,-2,0,0\n1,0,0,0\n0,-2,0,0\n5,-5,0,0\n0,0,0,0\n");
  const LoadErrors errors = errors_of(s, data);
  for (const auto& [row, a, b] : {std::tuple{0u, 3.0, -2.0}, {3u, 5.0, -5.0}}) {
    ASSERT_EQ(errors.of(row).cols(), 2);
    const MatrixX wanted = by_hand(a, b);
    EXPECT_LT((errors.of(row).bottomRows(2) - wanted).norm(), 1e-9 * wanted.norm()) << row;
  }
  const std::vector<VectorX> d = s.stand(data)->predict(data);
  for (const std::size_t row : {1u, 2u, 4u}) EXPECT_EQ(errors.of(row), MatrixX(t * d[row])) << "one load or none";

  // Σ = σ² + t² Σ_c p_c p_cᵀ: A stands still under 5 and −5 kN, and yet is known to t √2 · 5 kN / k1 only.
  const std::vector<MeasuredValue> values = measured_values(data);
  const statistics::Uncertainty u(MatrixX(10, 0), values, std::vector<double>(10, sigma), errors);
  Eigen::SparseMatrix<double, Eigen::RowMajor> T(10, 10);
  T.setIdentity();
  const MatrixX covariance = u.covariance(T), own = by_hand(5, -5),
                wanted = own * own.transpose() + sigma * sigma * MatrixX::Identity(2, 2);
  EXPECT_LT((covariance.block(6, 6, 2, 2) - wanted).norm(), 1e-9 * wanted.norm());
  EXPECT_EQ(covariance(6, 4), 0) << "errors of another row are others";
  EXPECT_NEAR(errors.deviation(values[6]), std::sqrt(2) * t * 5e3 / k1, 1e-9 * t * 5e3 / k1);
  const fit::PredictedPlan p = fit::predict(s, data);
  EXPECT_NEAR(p.numbers[3 * p.numbers.size() / 5].deviation.load, std::sqrt(2) * t * 5e3 / k1, 1e-12);
}

// A factor on all readings of A, from N rows of two equal loads F: variance (σ² + 2 t² (F/k1)²) / (N (2 F/k1)²). With
// one error for both loads it would be twice as large in t².
TEST(LoadErrors, TheIntervalOfAFactorFollowsTheErrorsOfBothLoads) {
  const Subject s = frame_of();
  std::string csv = "load.near,load.far,a_mm\n";
  constexpr int N = 25;
  constexpr double F = 4;
  for (int n = 0; n < N; ++n) csv += fmt::format("{},{},0\n", F, F);
  const Measurements data = read(s, csv);
  const std::vector<MeasuredValue> values = measured_values(data);
  const std::vector<double> noise(values.size(), sigma);
  const statistics::Uncertainty u(MatrixX(std::ssize(values), 0), values, noise, errors_of(s, data));
  const VectorX d = statistics::rows_of(values, s.stand(data)->predict(data));
  const double move = 1e3 * F / k1, wanted = (sigma * sigma + 2 * t * t * move * move) / (N * 4 * move * move);
  EXPECT_NEAR(statistics::regress(u, d, d).covariance(0, 0), wanted, 1e-9 * wanted);
}

TEST(LoadErrors, ComponentsAtANodeAreOneLoad) {
  const Subject s = frame_of();
  const Measurements data =
      read(s, "load.near,node.B.fx_N,node.B.fz_N,a_mm,z_mm\n0,500,-20,0,0\n1,500,-20,0,0\n0.5,500,0,0,0\n");
  const LoadErrors errors = errors_of(s, data);
  ASSERT_EQ(errors.of(0).cols(), 1);
  ASSERT_EQ(errors.of(1).cols(), 2);
  EXPECT_NEAR(errors.of(1)(6, 0), t * 1000 / k1, 1e-15);
  EXPECT_EQ(errors.of(1)(7, 0), 0);
  EXPECT_NEAR(errors.of(1)(6, 1), t * 500 / k1, 1e-15);
  EXPECT_NEAR(errors.of(1)(7, 1), errors.of(0)(7, 0), 1e-12);
}

// What is no sum of the loads (here a spring that hardens or softens, and one that rubs) is shared, so that the loads
// together do what a single one would do.
TEST(LoadErrors, LoadsTogetherDoWhatIsPredicted) {
  for (const char* law : {"law: hardening, stiffness: 1e5 N/mm, reference: 0.01 mm",
                          "law: power, force: 1 kN, deflection: 2 um, exponent: 0.5",
                          "law: friction, force: 500 N, stiffness: 1e5 N/mm"}) {
    const Subject s = frame_of(springs(fmt::format(", beside: {{ux: {{{}}}}}", law)));
    const Measurements data = read(s, "sequence,load.near,load.far,a_mm,b_mm\n1,3,-1,0,0\n2,0,-2,0,0\n3,1,2,0,0\n");
    const LoadErrors errors = errors_of(s, data);
    const std::vector<VectorX> d = s.stand(data)->predict(data);
    for (const std::size_t row : {0u, 1u, 2u}) {
      EXPECT_EQ(errors.of(row).cols(), row == 1 ? 1 : 2);
      EXPECT_LT((errors.of(row).rowwise().sum() - t * d[row]).norm(), 1e-12 * d[row].norm()) << law;
    }
    EXPECT_GT(errors.of(0)(6, 0), t * d[0](6)) << "3 and −1 kN do more than 2 kN";
  }
}

TEST(LoadErrors, HandleAndToolPointOfAMachineErrApart) {
  Mechanism m =
      test::with(test::device("haptic-6psu-ideal-joints"), "loads", "{handle: {point: [20 mm, -10 mm, 60 mm]}}");
  m.tolerances.load = t;
  const Subject s = m;
  const std::string command = "pose,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg,fx_N,fy_N,fz_N,handle.fx_N,ux_mm\n";
  const std::string at = "c,0,0,173.9,0,0,0,";
  const Measurements data =
      read(s, command + at + "10,0,5,-8,0\n" + at + "10,0,5,0,0\n" + at + "0,0,0,-8,0\n" + at + "10,3,5,0,0\n");
  const LoadErrors errors = errors_of(s, data);
  ASSERT_EQ(errors.of(0).cols(), 2);
  ASSERT_EQ(errors.of(3).cols(), 1) << "components at T are one load";
  EXPECT_LT((errors.of(0).col(0) - errors.of(2)).norm(), 1e-9 * errors.of(2).norm());
  EXPECT_LT((errors.of(0).col(1) - errors.of(1)).norm(), 1e-9 * errors.of(1).norm());
}

// Where nobody tells the noise it is read off what scatters, and errors of the loads scatter too. Noise of 60 nm beside
// 1 % of 6 µm makes 85: of 800 readings s² is known to 5 %, so σ² to 10 % and σ to 5 %.
TEST(LoadErrors, DoNotCountTwiceWhereTheScatterTellsTheNoise) {
  std::string yaml = springs();
  for (std::size_t at; (at = yaml.find(", sigma: 0.01 um")) != yaml.npos;) yaml.erase(at, 16);
  const Subject s = frame_of(yaml);
  constexpr double noise = 6e-8;
  for (const bool repeated : {true, false}) {
    Random random{repeated ? 7u : 8u};
    std::string csv = "load.near,a_mm\n";
    for (int i = 0; i < 800; ++i) {
      const double load = repeated ? 1 : 1 + 1e-3 * i / 800;  // of other loads none is a replicate
      const double a = 1e3 * load / k1 * (1 + t * random.normal()) + noise * random.normal();
      csv += fmt::format("{:.9f},{:.12g}\n", load, 1e3 * a);
    }
    const Measurements data = read(s, csv);
    const compare::Comparison c = compare::compare(s, data);
    EXPECT_NEAR(c.sigma.front(), noise, 0.17 * noise) << (repeated ? "replicates" : "what no pattern explains");
  }
  EXPECT_DOUBLE_EQ(statistics::noise_beside_loads(5, 16), 3);
  EXPECT_DOUBLE_EQ(statistics::noise_beside_loads(5, 36), std::sqrt(2.5)) << "a tenth of the variance stays";
}

// Under 5 and −5 kN sensor A scatters by t √2 · 5 kN / k1: with one error for both loads it would not.
TEST(LoadErrors, SimulateDrawsOneForEachLoad) {
  const Subject s = frame_of();
  std::string csv = "load.near,load.far,a_mm\n";
  constexpr int N = 400;
  for (int i = 0; i < N; ++i) csv += "5,-5,0\n";
  const Measurements out = subject::simulate_frame(*s.frame(), read(s, csv), {});
  double squares = 0;
  for (const Reading& r : out.readings) squares += *r.sensors[0] * *r.sensors[0] / N;
  const double wanted = std::sqrt(2) * t * 5e3 / k1;
  EXPECT_NEAR(std::sqrt(squares), std::hypot(wanted, sigma), 0.12 * wanted);  // 3.4 standard errors
}

}  // namespace
}  // namespace deflect
