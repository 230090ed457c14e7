// Noise that nobody tells, from what no pattern explains.
#include "validation/statistics/channel_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "msa/base/index.h"
#include "validation/measurement/random.h"

namespace deflect {
namespace {

using measurement::MeasuredValue;
using measurement::Quantity;

/// Numbers of channels 6, 7, … with noise of these σ, one of each a reading, beside an offset of each.
struct Channels {
  Channels(const std::vector<double>& sigma, const std::vector<Quantity>& quantity, std::size_t readings,
           unsigned seed = 5) {
    measurement::Random random{seed};
    const std::size_t n = sigma.size();
    patterns = MatrixX::Zero(as_index(n * readings), as_index(n));
    for (std::size_t r = 0; r < readings; ++r)
      for (std::size_t c = 0; c < n; ++c) {
        MeasuredValue v{r, 6 + c, sigma[c] * random.normal3().x(), {}, quantity[c]};
        patterns(as_index(values.size()), as_index(c)) = 1;
        values.push_back(v);
      }
    told.resize(values.size());
  }

  VectorX residual() const {
    VectorX r(std::ssize(values));
    for (std::size_t i = 0; i < values.size(); ++i) r(as_index(i)) = values[i].value;
    return r;
  }
  std::optional<std::vector<double>> noise(const MatrixX& A) const {
    return statistics::channel_noise(values, told, residual(), patterns, statistics::PartedColumns(A),
                                     VectorX::Zero(std::ssize(values)));
  }
  std::optional<std::vector<double>> noise() const { return noise(MatrixX::Zero(std::ssize(values), 0)); }

  std::vector<MeasuredValue> values;
  std::vector<std::optional<double>> told;
  MatrixX patterns;
};

const std::vector<Quantity> length_and_force = {Quantity::length, Quantity::force};

/// Beside a constant: from the sample's variance s², with n − 1 = 39 freedoms, the mean of σ², 39 s²/37.
TEST(ChannelNoise, BesideAnOffsetIsTheSamplesOwn) {
  const Channels c({2e-6, 30}, length_and_force, 40);
  const auto sigma = c.noise();
  ASSERT_TRUE(sigma);
  for (const std::size_t channel : {0u, 1u}) {
    double sum = 0, squares = 0;
    for (std::size_t i = channel; i < c.values.size(); i += 2) sum += c.values[i].value;
    for (std::size_t i = channel; i < c.values.size(); i += 2) squares += std::pow(c.values[i].value - sum / 40, 2);
    EXPECT_NEAR(sigma->at(channel), std::sqrt(squares / 37), 1e-4 * sigma->at(channel));
  }
}

TEST(ChannelNoise, WhatIsToldStays) {
  Channels c({2e-6, 30}, length_and_force, 40);
  const auto free = c.noise();
  for (std::size_t i = 0; i < c.told.size(); i += 2) c.told[i] = 5e-6;
  const auto sigma = c.noise();
  ASSERT_TRUE(sigma && free);
  for (std::size_t i = 0; i < c.told.size(); i += 2) {
    EXPECT_EQ(sigma->at(i), 5e-6);
    EXPECT_NEAR(sigma->at(i + 1), free->at(1), 1e-9 * free->at(1));  // no pattern joins the channels
  }
  for (std::size_t i = 1; i < c.told.size(); i += 2) c.told[i] = 30;
  EXPECT_EQ(c.noise()->at(1), 30);
}

/// A pattern over two channels is known from the quiet one; in another unit the noisy one has as much more noise.
TEST(ChannelNoise, NoUnitCountsMoreThanAnother) {
  Channels c({2e-6, 30}, length_and_force, 40);
  MatrixX joint(c.patterns.rows(), 1);
  for (Eigen::Index i = 0; i < joint.rows(); ++i) joint(i, 0) = std::sin(static_cast<double>(i)) * (i % 2 ? 1e3 : 1e-3);
  c.patterns.conservativeResize(Eigen::NoChange, 3);
  c.patterns.col(2) = joint;
  const auto sigma = c.noise();
  for (Eigen::Index i = 1; i < joint.rows(); i += 2) {
    c.values[as_size(i)].value *= 4.448;
    c.patterns.row(i) *= 4.448;
  }
  const auto scaled = c.noise();
  ASSERT_TRUE(sigma && scaled);
  EXPECT_NEAR(scaled->at(0), sigma->at(0), 1e-9 * sigma->at(0));
  EXPECT_NEAR(scaled->at(1), 4.448 * sigma->at(1), 1e-9 * scaled->at(1));
}

/// Many samples: the variances are met on average, the shared pattern notwithstanding; of the noisiest channel, whose
/// freedoms are 14 less a part of one, ν/(ν − 2) is between 1.167 and 1.182. The standard error of the mean variance of
/// 200 samples of 15 numbers is √(2/14/200) ≈ 2.7 % of it.
TEST(ChannelNoise, VariancesAreMetOnAverage) {
  const std::vector<double> truth = {2e-6, 30, 4};
  std::vector<double> mean(3, 0);
  constexpr unsigned samples = 200;
  for (unsigned seed = 1; seed <= samples; ++seed) {
    Channels c(truth, {Quantity::length, Quantity::force, Quantity::force}, 15, seed);
    c.patterns.conservativeResize(Eigen::NoChange, 4);
    for (Eigen::Index i = 0; i < c.patterns.rows(); ++i)
      c.patterns(i, 3) = std::sin(1.7 * static_cast<double>(i)) * truth[as_size(i % 3)];
    const auto sigma = c.noise();
    ASSERT_TRUE(sigma);
    for (std::size_t k = 0; k < 3; ++k) mean[k] += std::pow(sigma->at(k) / truth[k], 2) / samples;
  }
  for (const double each : mean) EXPECT_NEAR(each, 1.174, 1.174 * 3 * 0.027);
}

/// What tolerances can explain is no noise: a residual along one, as large as its standard deviation.
TEST(ChannelNoise, WhatTolerancesExplainIsNone) {
  Channels c({2e-6, 30}, length_and_force, 40);
  const auto without = c.noise();
  MatrixX A(c.patterns.rows(), 1);
  for (Eigen::Index i = 0; i < A.rows(); ++i) A(i, 0) = std::cos(static_cast<double>(i)) * (i % 2 ? 3e3 : 2e-4);
  for (Eigen::Index i = 0; i < A.rows(); ++i) c.values[as_size(i)].value += A(i, 0);
  const auto beside = c.noise(A), blamed = c.noise();
  ASSERT_TRUE(without && beside && blamed);
  EXPECT_NEAR(beside->at(0), without->at(0), 0.05 * without->at(0));  // one freedom of 39
  EXPECT_GT(blamed->at(0), 10 * without->at(0));
}

/// A channel that is read four times beside an offset and a slope has two freedoms: too few for a σ of its own.
TEST(ChannelNoise, ChannelsOfFewFreedomsShareOne) {
  Channels c({30, 30}, {Quantity::force, Quantity::force}, 40);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < std::ssize(c.values); ++i)
    if (i % 2 == 0 || i < 8) kept.push_back(i);
  std::vector<MeasuredValue> values;
  for (const Eigen::Index i : kept) values.push_back(c.values[as_size(i)]);
  c.values = values;
  c.patterns = MatrixX(c.patterns(kept, Eigen::all));
  c.told.resize(values.size());
  c.patterns.conservativeResize(Eigen::NoChange, 3);
  for (Eigen::Index i = 0; i < c.patterns.rows(); ++i)
    c.patterns(i, 2) = values[as_size(i)].channel == 7 ? static_cast<double>(i * i) : 0;
  const auto sigma = c.noise();
  ASSERT_TRUE(sigma);
  EXPECT_EQ(sigma->at(0), sigma->at(1));
  for (MeasuredValue& v : c.values)
    if (v.channel == 7) v.quantity = Quantity::moment;  // which no other channel shares
  EXPECT_FALSE(c.noise());
}

/// The factor of a sensor that is predicted to read nothing is such a pattern.
TEST(ChannelNoise, APatternOfZerosTakesNoFreedom) {
  Channels c({2e-6, 30}, length_and_force, 40);
  const auto without = c.noise();
  c.patterns.conservativeResize(Eigen::NoChange, 3);
  c.patterns.col(2).setZero();
  ASSERT_TRUE(without && c.noise());
  for (const std::size_t i : {0u, 1u}) EXPECT_NEAR(c.noise()->at(i), without->at(i), 1e-9 * without->at(i));
}

TEST(ChannelNoise, TenFreedomsAreWanted) {
  EXPECT_FALSE(Channels({2e-6}, {Quantity::length}, 10).noise());
  EXPECT_TRUE(Channels({2e-6}, {Quantity::length}, 11).noise());
}

/// Readings that are computed have the noise of rounding: 1e-12 of the largest of their kind.
TEST(ChannelNoise, RoundingIsTheLeast) {
  Channels c({1e-20, 1}, {Quantity::force, Quantity::force}, 40);
  for (std::size_t i = 1; i < c.values.size(); i += 2) c.values[i].value += 1e6;
  const auto sigma = c.noise();
  ASSERT_TRUE(sigma);
  EXPECT_NEAR(sigma->at(0), 1e-6 * std::sqrt(39.0 / 37), 1e-10);
}

}  // namespace
}  // namespace deflect
