// Errors eliminated block by block and group by group, against the dense covariance that they make together.
#include "validation/statistics/whitening.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <numeric>

#include "validation/compare/held_out.h"
#include "validation/compare/residual_study.h"
#include "validation/diagnosis/discrepancy.h"
#include "validation/measurement/random.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/scaled_groups.h"
#include "validation/statistics/uncertainty.h"

namespace deflect {
namespace {

using namespace compare;
using namespace diagnosis;
using namespace measurement;
using namespace parallel;
using namespace statistics;

// Eigenvalues of the covariances lie between 1 and some hundreds: of products of 60 numbers each a rounding of 1e-16,
// amplified by that, 1e-12 of the whole is left with a margin of ten.
constexpr double kept_to = 1e-12;

MatrixX normal(Random& random, Eigen::Index rows, Eigen::Index columns) {
  MatrixX out(rows, columns);
  for (double& x : out.reshaped()) x = random.normal();
  return out;
}

/// Blocks of one to four numbers, dealt out to four groups in turn or one after the other; one group has fewer numbers
/// than columns, some blocks are in no group.
struct Errors {
  std::vector<NoiseBlock> blocks;
  std::vector<std::size_t> group_of_block;
  PartedColumns A;

  Errors(std::uint64_t seed, bool in_turn) {
    Random random(seed);
    A.groups.resize(4);
    Eigen::Index rows = 0;
    for (std::size_t b = 0; b < 24; ++b) {
      const auto size = static_cast<Eigen::Index>(random.uniform(1, 4.999));
      const MatrixX root = normal(random, size, size);
      blocks.push_back({rows, size, MatrixX::Identity(size, size) + root * root.transpose()});
      std::size_t group = in_turn ? b % 5 : b / 5;  // the last: none
      if (group == 2 && b > (in_turn ? 2u : 10u)) group = 4;
      group_of_block.push_back(group);
      for (Eigen::Index i = 0; group < 4 && i < size; ++i) A.groups[group].rows.push_back(rows + i);
      rows += size;
    }
    A.shared = normal(random, rows, 3);
    for (std::size_t g = 0; g < 4; ++g)
      A.groups[g].columns = normal(random, std::ssize(A.groups[g].rows), g == 2 ? 6 : 2);
  }

  Eigen::Index rows() const { return A.rows(); }
  MatrixX covariance() const {
    MatrixX out = A.dense() * A.dense().transpose();
    for (const NoiseBlock& b : blocks)
      if (b.covariance.size() > 0) out.block(b.first, b.first, b.size, b.size) += b.covariance;
    return out;
  }
};

std::vector<Errors> random_errors() {
  std::vector<Errors> out;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) out.emplace_back(seed, seed % 2 == 0);
  return out;
}

void expect_close(const MatrixX& found, const MatrixX& wanted, double times = 1) {
  ASSERT_EQ(found.rows(), wanted.rows());
  ASSERT_EQ(found.cols(), wanted.cols());
  EXPECT_LT((found - wanted).norm(), times * kept_to * wanted.norm());
}

void expect_log_determinant(double found, const Eigen::LLT<MatrixX>& covariance) {
  const double wanted = 2 * covariance.matrixLLT().diagonal().array().log().sum();
  EXPECT_NEAR(found, wanted, kept_to * std::max(1.0, std::abs(wanted)));
}

TEST(PartedColumns, AreTheMatrixThatTheyStandFor) {
  for (const Errors& e : random_errors()) {
    Random random(7);
    const MatrixX dense = e.A.dense();
    EXPECT_EQ(dense.cols(), e.A.cols());
    const VectorX x = normal(random, e.A.cols(), 1);
    expect_close(e.A * x, dense * x);
    expect_close(e.A.squared_row_norms(), dense.rowwise().squaredNorm());
  }
}

TEST(Whitening, WeighsByTheInverseOfTheDenseCovariance) {
  for (const Errors& e : random_errors()) {
    Random random(8);
    const Whitening white(e.blocks, e.A);
    const MatrixX X = normal(random, e.rows(), 3), Y = normal(random, e.rows(), 2);
    const Eigen::LLT<MatrixX> dense(e.covariance());
    expect_close(white(X).transpose() * white(Y), X.transpose() * dense.solve(Y));
    expect_close(white.amplitudes(Y.col(0)), e.A.dense().transpose() * dense.solve(Y.col(0)));
    expect_close(white.undo_shared(white.of_shared(X)), X);
    expect_close(white.of_shared(white.within_groups(X)), white(X));
    expect_close(white.undo(white(X)), X);
    expect_log_determinant(white.log_determinant(), dense);
  }
}

TEST(Whitening, ManyColumnsAreThoseTakenOneByOneWhateverTheThreads) {
  const Errors e(4, true);
  Random random(12);
  const MatrixX X = normal(random, e.rows(), 4001), alone = Whitening(e.blocks, e.A, 1)(X);
  ASSERT_GT(X.size(), 200'000);  // so many are shared among threads
  for (const int threads : {2, 5}) EXPECT_EQ(Whitening(e.blocks, e.A, threads)(X), alone);
  MatrixX one_by_one(X.rows(), X.cols());
  const Whitening white(e.blocks, e.A);
  for (Eigen::Index i = 0; i < X.cols(); ++i) one_by_one.col(i) = white(X.col(i));
  expect_close(alone, one_by_one);
}

TEST(Whitening, NumbersWithoutACovarianceDoNotCount) {
  Errors e(3, true);
  const NoiseBlock out = e.blocks[5];
  e.blocks[5].covariance.resize(0, 0);
  std::vector<Eigen::Index> others;
  for (Eigen::Index i = 0; i < e.rows(); ++i)
    if (i < out.first || i >= out.first + out.size) others.push_back(i);
  Random random(9);
  const MatrixX X = normal(random, e.rows(), 2), white = Whitening(e.blocks, e.A)(X);
  EXPECT_EQ(white.middleRows(out.first, out.size).norm(), 0);
  const MatrixX back = Whitening(e.blocks, e.A).undo(white);
  EXPECT_EQ(back.middleRows(out.first, out.size).norm(), 0);
  expect_close(back(others, Eigen::all), X(others, Eigen::all));
  const MatrixX kept = X(others, Eigen::all), covariance = e.covariance()(others, others);
  expect_close(white.transpose() * white, kept.transpose() * covariance.llt().solve(kept));
  expect_log_determinant(Whitening(e.blocks, e.A).log_determinant(), covariance.llt());
}

TEST(Whitening, TheOrderOfRowsAndGroupsDoesNotMatter) {
  for (const Errors& e : random_errors()) {
    Random random(10);
    const MatrixX X = normal(random, e.rows(), 2), white = Whitening(e.blocks, e.A)(X);
    // Blocks from the last to the first, and so the groups.
    Errors turned = e;
    std::vector<Eigen::Index> place(static_cast<std::size_t>(e.rows())), from(place.size());
    Eigen::Index at = 0;
    for (std::size_t b = 0; b < e.blocks.size(); ++b) {
      const NoiseBlock& old = e.blocks[e.blocks.size() - 1 - b];
      turned.blocks[b] = {at, old.size, old.covariance};
      for (Eigen::Index i = 0; i < old.size; ++i, ++at) {
        place[static_cast<std::size_t>(old.first + i)] = at;
        from[static_cast<std::size_t>(at)] = old.first + i;
      }
    }
    turned.A.shared = e.A.shared(from, Eigen::all);
    std::reverse(turned.A.groups.begin(), turned.A.groups.end());
    for (GroupColumns& g : turned.A.groups) {
      std::vector<std::pair<Eigen::Index, Eigen::Index>> order;
      for (std::size_t i = 0; i < g.rows.size(); ++i)
        order.emplace_back(place[static_cast<std::size_t>(g.rows[i])], static_cast<Eigen::Index>(i));
      std::sort(order.begin(), order.end());
      const MatrixX columns = g.columns;
      for (std::size_t i = 0; i < order.size(); ++i) {
        g.rows[i] = order[i].first;
        g.columns.row(static_cast<Eigen::Index>(i)) = columns.row(order[i].second);
      }
    }
    const MatrixX again = Whitening(turned.blocks, turned.A)(X(from, Eigen::all));
    expect_close(again.transpose() * again, white.transpose() * white);
  }
}

TEST(Whitening, KnowsTheLengthOfColumnsOfAGroup) {
  for (const Errors& e : random_errors()) {
    const Whitening white(e.blocks, e.A);
    Random random(11);
    std::vector<GroupColumns> columns;
    for (const GroupColumns& g : e.A.groups) columns.push_back({g.rows, normal(random, std::ssize(g.rows), 3)});
    const PartedColumns bare = [&] {
      PartedColumns out(MatrixX(e.rows(), 0));
      out.groups = columns;
      return out;
    }();
    const MatrixX whole = white(bare.dense());
    white.white_within_groups(columns);
    for (std::size_t g = 0; g < columns.size(); ++g)
      expect_close(white.norms_of_shared(columns[g]),
                   whole.middleCols(3 * static_cast<Eigen::Index>(g), 3).colwise().norm().transpose(), 10);
  }
}

/// −2 ln L of the restricted likelihood, written out with the residual's part beside F.
double dense_restricted(const MatrixX& covariance, const MatrixX& F, const VectorX& r) {
  const Eigen::HouseholderQR<MatrixX> qr(F);
  const MatrixX Q = qr.householderQ();
  const MatrixX beside = Q.rightCols(F.rows() - F.cols());
  const MatrixX S = beside.transpose() * covariance * beside;
  const VectorX left = beside.transpose() * r;
  const Eigen::LLT<MatrixX> llt(S);
  return left.dot(llt.solve(left)) + 2 * llt.matrixLLT().diagonal().array().log().sum();
}

TEST(ScaledGroups, HasTheRestrictedLikelihoodOfItsCovariance) {
  for (const Errors& e : random_errors()) {
    Random random(12);
    const MatrixX P = e.A.shared, F = orthonormal(normal(random, e.rows(), 2));
    const VectorX r = normal(random, e.rows(), 1) + e.A * normal(random, e.A.cols(), 1);
    const ScaledGroups groups(e.A.groups, P, F, 1e-13);
    PartedColumns own(MatrixX(e.rows(), 0));
    own.groups = e.A.groups;
    const MatrixX C = own.dense(), one = MatrixX::Identity(e.rows(), e.rows());
    const auto dense = [&](double g, double p) {
      return dense_restricted(one + g * C * C.transpose() + p * P * P.transpose(), F, r);
    };
    const auto found = [&](double g, double p) { return -2 * groups.log_likelihood(groups.at(g, p), groups.seen(r)); };
    for (const auto& [g, p] : {std::pair{1.0, 1.0}, {4.0, 4.0}, {100.0, 1.0}, {1e-6, 1.0}})
      EXPECT_NEAR(found(g, p) - found(0, 1), dense(g, p) - dense(0, 1), 1e3 * kept_to * dense(0, 1));
  }
}

TEST(ScaledGroups, WhatIsFittedHasNothingLeftToSay) {
  const Errors e(5, true);
  Random random(13);
  PartedColumns own(MatrixX(e.rows(), 0));
  own.groups = e.A.groups;
  const VectorX r = normal(random, e.rows(), 1);
  // F in the span of C: one freedom less, and the gain is that of the projection beside it.
  const MatrixX C = own.dense(), F = orthonormal(MatrixX(C * normal(random, C.cols(), 1)));
  const ScaledGroups groups(e.A.groups, MatrixX(e.rows(), 0), F, 1e-10);
  const MatrixX left = C - F * (F.transpose() * C), Q = orthonormal(left, 1e-8);
  const ScaledGroups::Gain gain = groups.free_gain(groups.seen(r), 1e-6);
  EXPECT_EQ(gain.freedoms, Q.cols());
  EXPECT_NEAR(gain.gain, (Q.transpose() * r).squaredNorm(), 1e-9 * r.squaredNorm());
}

TEST(Discrepancy, IsTheSameByGroupsAndDense) {
  for (const Errors& e : random_errors()) {
    Random random(14);
    const auto white = std::make_shared<const Whitening>(e.blocks, e.A);
    PartedColumns parted(MatrixX(e.rows(), 0));
    for (const GroupColumns& g : e.A.groups) parted.groups.push_back({g.rows, normal(random, std::ssize(g.rows), 2)});
    const auto by_groups = std::make_shared<const WhitenedFamilies>(Families{parted}, white);
    const auto dense = std::make_shared<const WhitenedFamilies>(Families{PartedColumns(parted.dense())}, white);
    const VectorX r = (*white)(MatrixX(normal(random, e.rows(), 1) + 2 * (parted * normal(random, 8, 1))));
    for (const MatrixX& fitted : {MatrixX(), (*white)(normal(random, e.rows(), 2))}) {
      const Discrepancy a(by_groups, fitted), b(dense, fitted);
      EXPECT_NEAR(a.log_evidence(r), b.log_evidence(r), 1e4 * kept_to * r.squaredNorm());
      EXPECT_NEAR(a.p_value(r), b.p_value(r), 1e-9 * b.p_value(r));
      EXPECT_EQ(a.likeliest(r).tau, b.likeliest(r).tau);
      EXPECT_NEAR(a.chi2(r, a.likeliest(r)), b.chi2(r, a.likeliest(r)), 1e3 * kept_to * r.squaredNorm());
    }
  }
}

/// Readings of three numbers at four poses, in turn; errors of poses kept by pose, and as columns of all.
struct Readings {
  std::vector<MeasuredValue> values;
  std::vector<double> sigma;
  std::vector<VectorX> d;
  Measurements data;
  ResidualStudy study;
  PartedColumns A, dense;
  Random random{15};

  Readings() {
    A.groups.resize(4);
    data.poses.resize(4);
    for (std::size_t reading = 0; reading < 40; ++reading) {
      d.push_back(Vector6::Zero());
      d.back().head<3>() = 1e-4 * random.normal3();
      data.readings.emplace_back();
      data.readings.back().pose = reading % 4;
      for (std::size_t k = 0; k < 3; ++k) {
        A.groups[reading % 4].rows.push_back(std::ssize(values));
        values.push_back(tool_point_value(reading, k, d.back()(static_cast<Eigen::Index>(k)), {}));
        sigma.push_back(1e-6 * random.uniform(1, 3));
      }
    }
    A.shared = 3e-6 * normal(random, 120, 3);
    for (GroupColumns& g : A.groups) g.columns = 3e-6 * normal(random, 30, 2);
    dense = A.dense();
    study.data = &data;
    study.values = values;
  }
  Uncertainty uncertainty(const PartedColumns& errors) const {
    return Uncertainty(errors, values, sigma, LoadErrors(0.01, d));
  }
};

TEST(Uncertainty, IsTheSameWhetherErrorsArePartedOrNot) {
  Readings s;
  const Uncertainty parted = s.uncertainty(s.A), dense = s.uncertainty(s.dense);
  const MatrixX X = normal(s.random, 120, 3);
  expect_close(parted.inner(X, X), dense.inner(X, X));
  const VectorX r = s.A * normal(s.random, s.A.cols(), 1) * 2.2 + 2e-6 * normal(s.random, 120, 1);
  expect_close(parted.nuisances(r), dense.nuisances(r));
  EXPECT_EQ(parted.scale_of_tolerances(r, X), dense.scale_of_tolerances(r, X));
  const double held_out = HeldOut(s.study, dense, std::vector<bool>(40, false)).rmse(r);
  EXPECT_NEAR(HeldOut(s.study, parted, std::vector<bool>(40, false)).rmse(r), held_out, 1e-11 * held_out);
}

TEST(Uncertainty, ContrastsWithinPosesHaveTheCovarianceOfTheirReadings) {
  Readings s;
  Eigen::SparseMatrix<double, Eigen::RowMajor> T(3, 120);
  T.insert(0, 0) = 0.5;  // of pose 0
  T.insert(0, 12) = -0.5;
  T.insert(1, 1) = 0.5;
  T.insert(1, 13) = -0.5;
  T.insert(2, 3) = 1;  // of pose 1
  T.insert(2, 15) = 1;
  expect_close(s.uncertainty(s.A).covariance(T), s.uncertainty(s.dense).covariance(T));
}

}  // namespace
}  // namespace deflect
