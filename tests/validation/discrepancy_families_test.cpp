// The patterns of an unknown effect, number by number, written out from their words in discrepancy.h.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "msa/base/index.h"
#include "msa/frame/file/frame_file.h"
#include "tests/support/devices.h"
#include "tests/support/paths.h"
#include "validation/compare/slides.h"
#include "validation/diagnosis/discrepancy.h"
#include "validation/measurement/random.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"
#include "validation/statistics/columns.h"
#include "validation/subject/simulate_frame.h"

namespace deflect::diagnosis {
namespace {

enum Family { sites, poses, loads };

double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// Every reading's powers: of each load f_k its sign, size, signed square and its product with the next; of time from
/// −1 to 1 its square and cube; of the temperature above 20 °C the square.
std::vector<double> powers(const VectorX& f, double time, double warmer) {
  std::vector<double> out;
  for (Eigen::Index k = 0; k < f.size(); ++k)
    for (const double value : {sign(f(k)), std::abs(f(k)), f(k) * std::abs(f(k)), f(k) * f((k + 1) % f.size())})
      out.push_back(value);
  out.insert(out.end(), {time * time, time * time * time, warmer * warmer});
  return out;
}

class OfAMachine : public ::testing::Test {
 protected:
  static measurement::Measurements simulated() {
    const Mechanism m = test::device("haptic-6psu-ideal-joints");
    prediction::SimulationOptions o;
    o.sigma_th = 1e-5, o.swing = 4, o.geometry = Geometry::linear;
    measurement::Measurements data = prediction::simulate(m, prediction::campaign("cycle", m, 50, 1), o);
    measurement::Random random(3);
    for (measurement::Reading& r : data.readings) r.load += Vector6::Unit(1) * random.uniform(-9, 9);
    return data;
  }

  const measurement::Measurements data = simulated();
  const compare::ResidualStudy study =
      compare::residual_study(subject::Subject(test::device("haptic-6psu-ideal-joints")), data);
  const Families families = discrepancy_families(study);
};

TEST_F(OfAMachine, LoadsHavePowersAtEachFreedom) {
  double last = 0;
  for (const measurement::Reading& r : data.readings) last = std::max(last, *r.sequence);
  const MatrixX& X = families[loads].shared;
  ASSERT_EQ(X.cols(), 6 * (4 * 3 + 3));
  double warmest = 0;
  for (std::size_t i = 0; i < study.values.size(); ++i) {
    const measurement::MeasuredValue& v = study.values[i];
    const measurement::Reading& r = data.readings[v.reading];
    const double begin = *data.readings.front().sequence, warmer = r.temperature_C - 20;
    const std::vector<double> wanted = powers(r.load.head<3>(), 2 * (*r.sequence - begin) / (last - begin) - 1, warmer);
    warmest = std::max(warmest, warmer);
    for (std::size_t b = 0; b < wanted.size(); ++b)
      for (Eigen::Index c = 0; c < 6; ++c)
        ASSERT_NEAR(X(as_index(i), 6 * as_index(b) + c), as_index(v.channel) == c ? wanted[b] : 0,
                    1e-9 * std::abs(wanted[b]))
            << i << " " << b;
  }
  EXPECT_GT(warmest, 3);
}

TEST_F(OfAMachine, PosesHaveADisplacementAndACompliance) {
  const statistics::PartedColumns& X = families[poses];
  ASSERT_EQ(X.groups.size(), data.poses.size());
  EXPECT_EQ(X.shared.cols(), 0);
  std::size_t rows = 0;
  for (std::size_t p = 0; p < X.groups.size(); ++p)
    for (std::size_t k = 0; k < X.groups[p].rows.size(); ++k, ++rows) {
      const auto i = as_size(X.groups[p].rows[k]);
      const measurement::MeasuredValue& v = study.values[i];
      ASSERT_EQ(data.readings[v.reading].pose, p);
      const Vector6 F = data.readings[v.reading].load;
      for (Eigen::Index b = 0; b < 4; ++b)  // 10 N, then fx, fy, fz
        for (Eigen::Index c = 0; c < 6; ++c)
          ASSERT_NEAR(X.groups[p].columns(as_index(k), 6 * b + c),
                      as_index(v.channel) != c ? 0
                      : b == 0                 ? 10
                                               : F(b - 1),
                      1e-12);
    }
  EXPECT_EQ(rows, study.values.size());
}

// Behind the patterns of `compare`: elongations by the force f of a site and by its slide.
TEST_F(OfAMachine, SitesHaveElongationsByPowersOfTheirForce) {
  using Elongation = std::function<double(double f, const subject::Site&)>;
  ASSERT_TRUE(compare::has_slides(study));
  const double mean = compare::mean_extension(study);
  std::vector<Elongation> elongations = {
      [](double f, const auto&) { return sign(f); }, [](double f, const auto&) { return sign(f) * std::cbrt(f * f); },
      [](double f, const auto&) { return f * std::abs(f); }, [](double f, const auto&) { return std::abs(f); },
      [](double f, const auto& s) { return f * s.along; }};
  for (int power = 0; power < 5; ++power)
    elongations.emplace_back([=](double f, const subject::Site& s) {
      double out = f - f * s.along;
      for (int i = 0; i < power; ++i) out *= s.extension / mean;
      return out;
    });
  std::vector<MatrixX> parts;
  for (const Elongation& e : elongations)
    parts.push_back(statistics::rows_of(
        study.values, compare::site_columns(study, [&](std::size_t reading, std::size_t site) {
          return e(study.force[reading](as_index(site)), study.sites[data.readings[reading].pose][site]);
        })));
  parts.push_back(
      statistics::rows_of(study.values, compare::site_columns(study, [&](std::size_t reading, std::size_t site) {
                            return study.heading[reading](as_index(site));
                          })));
  const MatrixX wanted = statistics::side_by_side(parts, std::ssize(study.values));
  const MatrixX& X = families[sites].shared;
  ASSERT_EQ(wanted.cols(), 11 * 6);
  ASSERT_GT(X.cols(), wanted.cols());
  EXPECT_LT((X.rightCols(wanted.cols()) - wanted).cwiseAbs().maxCoeff(), 1e-9 * wanted.cwiseAbs().maxCoeff());
}

// A frame has no tool point: its sensors are its freedoms, its load cases its loads, each as a share of its largest.
TEST(OfAFrame, EachSensorReadsEachLoadInThreeWays) {
  const frame::FrameDescription f = frame::read_frame(test::source_dir() + "/validation/frames/truss-45.yaml");
  measurement::Measurements data = subject::simulate_frame(f, subject::frame_campaign("random", f, 1), {});
  for (measurement::Reading& r : data.readings) r.factors[1] *= 0.25;
  const compare::ResidualStudy s = compare::residual_study(subject::Subject(f), data);
  const Families families = discrepancy_families(s);
  const Eigen::Index n = std::ssize(f.sensors), cases = std::ssize(f.loads);
  ASSERT_LE(cases, 6);
  // The most used first.
  std::vector<Eigen::Index> order;
  for (Eigen::Index k = 0; k < cases; ++k) order.push_back(k);
  const auto used = [&](Eigen::Index k) {
    return std::count_if(data.readings.begin(), data.readings.end(),
                         [&](const auto& r) { return r.factors[as_size(k)] != 0; });
  };
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return used(a) > used(b); });
  const auto share = [&](Eigen::Index k, std::size_t reading) {
    double largest = 0;
    for (const auto& r : data.readings) largest = std::max(largest, std::abs(r.factors[as_size(k)]));
    return data.readings[reading].factors[as_size(k)] / largest;
  };
  const MatrixX& X = families[sites].shared;
  const MatrixX by_load = X.rightCols(3 * n * cases);
  for (std::size_t i = 0; i < s.values.size(); ++i)
    for (Eigen::Index k = 0; k < cases; ++k) {
      const double x = share(nth(order, k), s.values[i].reading);
      const std::array<double, 3> shapes = {x, std::abs(x), sign(x)};
      for (Eigen::Index b = 0; b < 3; ++b)
        for (Eigen::Index c = 0; c < n; ++c)
          ASSERT_NEAR(by_load(as_index(i), n * (3 * k + b) + c),
                      as_index(s.values[i].channel) - 6 == c ? nth(shapes, b) : 0, 1e-12);
    }
  const statistics::GroupColumns& pose = families[poses].groups.front();
  for (std::size_t k = 0; k < pose.rows.size(); ++k) {
    const measurement::MeasuredValue& v = nth(s.values, pose.rows[k]);
    for (Eigen::Index b = 0; b <= cases; ++b)
      ASSERT_NEAR(pose.columns(as_index(k), n * b + as_index(v.channel) - 6),
                  b == 0 ? 1 : share(nth(order, b - 1), v.reading), 1e-12);
  }
}

}  // namespace
}  // namespace deflect::diagnosis
