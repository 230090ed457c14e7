// The statistics of a diagnosis, against their definitions.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "validation/diagnosis/discrepancy.h"
#include "validation/measurement/random.h"
#include "validation/statistics/evidence.h"
#include "validation/statistics/tail.h"
#include "validation/statistics/uncertainty.h"

namespace deflect {
namespace {

using namespace diagnosis;
using namespace measurement;
using namespace statistics;

double log_normal_density(double x, double variance) {
  return -0.5 * (x * x / variance + std::log(2 * M_PI * variance));
}

MatrixX noise(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  Random random(seed);
  MatrixX out(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index k = 0; k < columns; ++k) out(i, k) = random.normal();
  return out;
}

// By hand, so that the two stand on nothing of their own below; sums that overflow without care are right too.
TEST(Evidence, MeansAndStepsAreThoseOfTheirWords) {
  EXPECT_NEAR(statistics::log_mean_exp({std::log(1.0), std::log(3.0)}), std::log(2.0), 1e-15);
  EXPECT_NEAR(statistics::log_mean_exp({1000 + std::log(1.0), 1000 + std::log(3.0)}), 1000 + std::log(2.0), 1e-12);
  EXPECT_NEAR(statistics::log_mean_exp({-1e6}), -1e6, 1e-9);
  const std::vector<double> steps = statistics::log_spaced(1, 16, 2);  // the middles of two octaves each
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_NEAR(steps[0], 2, 1e-14);
  EXPECT_NEAR(steps[1], 8, 1e-14);
}

// One parameter: z = a + N(0, 1), a ~ N(0, τ²), against a = 0: the mean over τ of N(z; 0, 1 + τ²)/N(z; 0, 1).
TEST(Evidence, OfOneParameterIsTheRatioOfMarginalDensities) {
  for (const double z : {0.0, 1.0, 3.0, 5.0, 20.0}) {
    std::vector<double> terms;
    for (const double tau : statistics::log_spaced(0.5, 500, 40))
      terms.push_back(log_normal_density(z, 1 + tau * tau) - log_normal_density(z, 1));
    EXPECT_NEAR(statistics::log_evidence(z * z, 1, false), statistics::log_mean_exp(terms), 1e-12 * (1 + z * z));
  }
}

// A sign that physics fixes doubles the prior on its side: by numbers, ∫₀^∞ 2 N(a; 0, τ²) N(z; a, 1) da.
TEST(Evidence, OfAFixedSignIsTheIntegralOverHalfThePrior) {
  for (const double z : {0.5, 2.0, 6.0}) {
    std::vector<double> terms;
    for (const double tau : statistics::log_spaced(0.5, 500, 40)) {
      const double width = 12 / std::sqrt(1 + 1 / (tau * tau)), middle = z * tau * tau / (1 + tau * tau);
      const double low = std::max(0.0, middle - width), h = (middle + width - low) / 20000;
      double sum = 0;
      for (int i = 0; i < 20000; ++i) {
        const double a = low + (i + 0.5) * h;
        sum += 2 * std::exp(log_normal_density(a, tau * tau) + log_normal_density(z - a, 1)) * h;
      }
      terms.push_back(std::log(sum) - log_normal_density(z, 1));
    }
    EXPECT_NEAR(statistics::log_evidence(z * z, 1, true), statistics::log_mean_exp(terms), 1e-4);
  }
}

TEST(Evidence, GrowsWithTheGainAndFallsWithTheParameters) {
  for (const double gain : {0.0, 5.0, 20.0, 100.0}) {
    EXPECT_LT(statistics::log_evidence(gain, 1, false), statistics::log_evidence(gain + 1, 1, false));
    EXPECT_GT(statistics::log_evidence(gain, 1, false), statistics::log_evidence(gain, 2, false));
    EXPECT_GT(statistics::log_evidence(gain, 2, false), statistics::log_evidence(gain, 3, false));
  }
  EXPECT_LT(statistics::log_evidence(0, 1, false), 0);  // nothing gained: it is not there, rather
  // A fit may leave more than nothing did: then the effect's own sense is no more likely than the other.
  EXPECT_LT(statistics::log_evidence(-5, 1, true), statistics::log_evidence(0, 1, true));
}

/// Of numbers that are white as they are.
Discrepancy of_white(const MatrixX& B, const MatrixX& fitted = {}) {
  std::vector<NoiseBlock> blocks;
  for (Eigen::Index i = 0; i < B.rows(); ++i) blocks.push_back({i, 1, MatrixX::Identity(1, 1)});
  const auto white = std::make_shared<const Whitening>(blocks, PartedColumns(MatrixX(B.rows(), 0)));
  return Discrepancy(std::make_shared<const WhitenedFamilies>(Families{PartedColumns(B)}, white), fitted);
}

// N(r; 0, 1 + τ²BBᵀ) written out with a dense covariance.
TEST(Discrepancy, HasTheEvidenceOfItsCovariance) {
  MatrixX B = noise(12, 3, 1);
  const VectorX r = noise(12, 1, 2) + 2 * B.col(1);
  const Discrepancy d = of_white(B);
  for (auto column : B.colwise()) column *= std::sqrt(12.0) / column.norm();
  std::vector<double> terms;
  for (const double tau : statistics::log_spaced(1e-3, 10, 40)) {
    const MatrixX S = MatrixX::Identity(12, 12) + tau * tau * B * B.transpose();
    terms.push_back(0.5 * (r.squaredNorm() - r.dot(S.llt().solve(r)) - std::log(S.determinant())));
  }
  EXPECT_NEAR(d.log_evidence(r), statistics::log_mean_exp(terms), 1e-9);
  const double tau = d.likeliest(r).tau;
  const MatrixX S = MatrixX::Identity(12, 12) + tau * tau * B * B.transpose();
  EXPECT_NEAR(d.chi2(r, d.likeliest(r)), r.dot(S.llt().solve(r)), 1e-9 * r.squaredNorm());
}

TEST(Discrepancy, SeesNothingOfWhatIsFitted) {
  const MatrixX B = noise(30, 2, 3);
  const Discrepancy all = of_white(B), beside = of_white(B, B.col(0));
  const VectorX r = 50 * B.col(0);
  EXPECT_LT(all.p_value(r), 1e-10);
  EXPECT_GT(beside.p_value(r), 0.999);
  EXPECT_LT(beside.log_evidence(r), 0.1);
}

TEST(Tail, IsThatOfPublishedTables) {
  EXPECT_NEAR(chi_squared_tail(1, 3.841459), 0.05, 1e-7);
  EXPECT_NEAR(chi_squared_tail(10, 18.307038), 0.05, 1e-7);
  EXPECT_EQ(chi_squared_tail(0, 3), 1);
  EXPECT_NEAR(normal_distribution(1.959964), 0.975, 1e-7);
}

// Residuals made of noise and tolerances s times as large: s is found, whatever patterns lie on top of them.
TEST(Uncertainty, ToleranceScaleIsFoundBesidePatterns) {
  std::vector<MeasuredValue> values(600);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = tool_point_value(i / 3, i % 3, 0, {});
  const std::vector<double> sigma(600, 1);
  const MatrixX A = 0.5 * noise(600, 80, 4), patterns = noise(600, 5, 5);
  const Uncertainty u(A, values, sigma, LoadErrors(0, std::vector<VectorX>(200, Vector6::Zero())));
  for (const double s : {1.0, 2.0, 2.5}) {
    const VectorX r = s * A * noise(80, 1, 6) + noise(600, 1, 7) + patterns * VectorX::Constant(5, 40);
    const double found = u.scale_of_tolerances(r, patterns);
    if (s == 1)
      EXPECT_EQ(found, 1);
    else
      EXPECT_NEAR(found / s, 1, 0.25);  // three deviations of a variance by 80 numbers, 1/√(2·80) each
  }
}

/// ln L of the part of r beside F, of covariance 1 + s² A Aᵀ, written out.
double restricted_log_likelihood(const MatrixX& A, const MatrixX& F, const VectorX& r, double s) {
  const MatrixX Q = MatrixX(F.householderQr().householderQ()).rightCols(F.rows() - F.cols());
  const Eigen::LLT<MatrixX> S(Q.transpose() * (MatrixX::Identity(r.size(), r.size()) + s * s * A * A.transpose()) * Q);
  const VectorX left = Q.transpose() * r;
  return -0.5 * left.dot(S.solve(left)) - S.matrixLLT().diagonal().array().log().sum();
}

// The likeliest of the factors 1, 1.1, 1.21 … 3 where ln of its likelihood is more than 2 above that of 1, else 1.
TEST(Uncertainty, ToleranceScaleIsTheLikeliestOfItsSteps) {
  std::vector<MeasuredValue> values(60);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = tool_point_value(i / 3, i % 3, 0, {});
  const MatrixX A = noise(60, 10, 8), F = noise(60, 2, 9);
  const Uncertainty u(A, values, std::vector<double>(60, 1), LoadErrors(0, std::vector<VectorX>(20, Vector6::Zero())));
  int little = 0, just_enough = 0;
  for (double times = 1; times < 3; times += 0.05) {
    const VectorX r = times * A * noise(10, 1, 10) + noise(60, 1, 11) + 30 * F * VectorX::Ones(2);
    double best = 1, rise = 0;
    for (double s = 1; s <= 3; s *= 1.1) {
      const double here = restricted_log_likelihood(A, F, r, s) - restricted_log_likelihood(A, F, r, 1);
      if (here > rise) rise = here, best = s;
    }
    EXPECT_EQ(u.scale_of_tolerances(r, F), rise > 2 ? best : 1) << times << " " << rise;
    little += rise > 1 && rise <= 2;
    just_enough += rise > 2 && rise < 4;
  }
  EXPECT_GT(little, 0);
  EXPECT_GT(just_enough, 0);
}

}  // namespace
}  // namespace deflect
