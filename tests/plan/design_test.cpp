#include "validation/plan/design.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <random>
#include <set>

#include "validation/plan/choice.h"
#include "validation/plan/observability.h"

namespace deflect::plan {
namespace {

MatrixX random_matrix(std::mt19937& random, Eigen::Index rows, Eigen::Index columns) {
  std::normal_distribution<double> normal;
  MatrixX out(rows, columns);
  for (double& x : out.reshaped()) x = normal(random);
  return out;
}

struct Drawn {
  std::vector<WhiteRows> blocks;
  MatrixX prior;  // of what is shared
};

/// Blocks at a few poses, two errors of each pose.
Drawn drawn(unsigned seed, int blocks, Eigen::Index targets, Eigen::Index shared) {
  std::mt19937 random(seed);
  Drawn out;
  for (int i = 0; i < blocks; ++i) {
    const Eigen::Index n = 1 + i % 3;
    out.blocks.push_back({random_matrix(random, n, targets), random_matrix(random, n, shared),
                          random_matrix(random, n, 2), static_cast<std::size_t>(i % 4)});
  }
  const MatrixX root = random_matrix(random, shared, shared);
  out.prior = root * root.transpose() + MatrixX::Identity(shared, shared);
  return out;
}

/// Tᵀ (1 + X Π Xᵀ)⁻¹ T by the definition, all at once.
MatrixX by_definition(const Drawn& d) {
  Eigen::Index n = 0;
  for (const WhiteRows& b : d.blocks) n += b.targets.rows();
  MatrixX T(n, d.blocks.front().targets.cols()), S = MatrixX::Identity(n, n);
  Eigen::Index at = 0;
  for (const WhiteRows& b : d.blocks) {
    T.middleRows(at, b.targets.rows()) = b.targets;
    Eigen::Index other_at = 0;
    for (const WhiteRows& other : d.blocks) {
      auto cell = S.block(at, other_at, b.targets.rows(), other.targets.rows());
      cell += b.shared * d.prior * other.shared.transpose();
      if (b.pose == other.pose) cell += b.own * other.own.transpose();
      other_at += other.targets.rows();
    }
    at += b.targets.rows();
  }
  return T.transpose() * Eigen::LLT<MatrixX>(S).solve(T);
}

Design empty(const Drawn& d) {
  const Eigen::Index shared = d.prior.rows(), targets = d.blocks.front().targets.cols();
  return {d.prior, MatrixX::Zero(shared, targets), MatrixX::Zero(targets, targets)};
}

TEST(PlanDesign, SumsInnovationsToWhatAllReadingsSay) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Drawn d = drawn(seed, 12, 3, 5);
    Design design = empty(d);
    for (const WhiteRows& b : d.blocks) {
      const MatrixX foreseen = design.with(b);
      design.take(b);
      EXPECT_LT((foreseen - design.Q()).norm(), 1e-9 * (1 + design.Q().norm()));
    }
    const MatrixX Q = by_definition(d);
    EXPECT_LT((design.Q() - Q).norm(), 1e-9 * Q.norm()) << seed;
  }
}

TEST(PlanDesign, DoesNotDependOnTheOrder) {
  Drawn d = drawn(7, 10, 2, 4);
  Design one = empty(d), other = empty(d);
  for (const WhiteRows& b : d.blocks) one.take(b);
  for (auto b = d.blocks.rbegin(); b != d.blocks.rend(); ++b) other.take(*b);
  EXPECT_LT((one.Q() - other.Q()).norm(), 1e-9 * one.Q().norm());
  EXPECT_LT((one.covariance() - other.covariance()).norm(), 1e-9 * one.covariance().norm());
}

TEST(PlanDesign, DeterminantAndTraceAreThoseOfTheCovariance) {
  const Drawn d = drawn(3, 6, 1, 5);
  std::mt19937 random(5);
  const MatrixX V = random_matrix(random, 4, 5);
  Design design = empty(d);
  for (const WhiteRows& b : d.blocks) {
    WhiteRows shared_only = b;
    shared_only.own = MatrixX(b.targets.rows(), 0);  // the determinant of what is shared alone
    const MatrixX before = design.covariance();
    const double log_determinant = design.log_determinant(shared_only), less = design.trace_decrease(shared_only, V);
    design.take(shared_only);
    const MatrixX after = design.covariance();
    EXPECT_NEAR(log_determinant, std::log(before.determinant() / after.determinant()), 1e-8);
    EXPECT_NEAR(less, (V * (before - after) * V.transpose()).trace(), 1e-9);
  }
}

// A block is taken off again as if it had never been there, whenever it was taken.
TEST(PlanDesign, WhatIsDroppedWasNeverThere) {
  std::mt19937 random(9);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Drawn d = drawn(seed, 12, 3, 5);
    const MatrixX V = random_matrix(random, 4, 5);
    Design design = empty(d);
    for (const WhiteRows& b : d.blocks) design.take(b);
    for (const std::size_t gone : {std::size_t{7}, std::size_t{0}, std::size_t{4}}) {
      const WhiteRows b = d.blocks[gone];
      const MatrixX foreseen = design.without(b), before = design.covariance();
      const double more = design.trace_increase(b, V);
      design.drop(b);
      EXPECT_LT((foreseen - design.Q()).norm(), 1e-9 * (1 + design.Q().norm()));
      EXPECT_NEAR(more, (V * (design.covariance() - before) * V.transpose()).trace(), 1e-8);
      d.blocks.erase(d.blocks.begin() + static_cast<std::ptrdiff_t>(gone));
    }
    const MatrixX Q = by_definition(d);
    EXPECT_LT((design.Q() - Q).norm(), 1e-8 * Q.norm()) << seed;
  }
}

TEST(PlanDesign, ATargetWithinWhatIsFittedAddsNothing) {
  Drawn d = drawn(11, 8, 1, 3);
  d.prior *= 1e8;  // all but free
  for (WhiteRows& b : d.blocks) b.targets = b.shared * Vector3(1, -2, 0.5);
  Design design = empty(d);
  for (const WhiteRows& b : d.blocks) design.take(b);
  EXPECT_LT(design.Q()(0, 0), 1e-5);
  EXPECT_GE(design.Q()(0, 0), 0);
}

/// The sum of independent gains: what is best is known.
class Sum final : public Aim {
 public:
  explicit Sum(std::vector<double> gains) : gains_(std::move(gains)) {}
  double value() const override { return value_; }
  double with(std::size_t block) const override { return value_ + (taken_.count(block) ? 0.1 : 1) * gains_[block]; }
  void take(std::size_t block) override { value_ = with(block), taken_.insert(block); }
  void drop(std::size_t block) override {
    taken_.erase(taken_.find(block));
    value_ -= (taken_.count(block) ? 0.1 : 1) * gains_[block];
  }
  std::unique_ptr<Aim> copy() const override { return std::make_unique<Sum>(*this); }

 private:
  std::vector<double> gains_;
  std::multiset<std::size_t> taken_;
  double value_ = 0;
};

TEST(PlanChoice, TakesTheBestBlocksForTheirReadings) {
  std::vector<Block> blocks;
  std::vector<double> gains;
  for (std::size_t i = 0; i < 30; ++i) {
    blocks.push_back({i, 1, i / 5});
    gains.push_back(static_cast<double>((i * 7) % 30 + 1));
  }
  blocks.push_back({30, 3, 9});
  gains.push_back(33);  // 11 a reading: behind the single ones from 12 on
  const Choice c = choose(Sum(gains), blocks, {6}, {1});
  EXPECT_EQ(c.readings.back(), 6u);
  EXPECT_DOUBLE_EQ(c.values.back(), 30 + 29 + 28 + 27 + 26 + 25);
  EXPECT_TRUE(std::is_sorted(c.values.begin(), c.values.end()));
  const Choice again = choose(Sum(gains), blocks, {6}, {2});
  EXPECT_EQ(c.blocks, again.blocks);  // whatever the number of threads
}

TEST(PlanChoice, KeepsToTheNumberOfPoses) {
  std::vector<Block> blocks;
  std::vector<double> gains;
  for (std::size_t i = 0; i < 30; ++i) {
    blocks.push_back({i, 1, i % 6});
    gains.push_back(static_cast<double>(i + 1));
  }
  for (const std::size_t readings : {std::size_t{8}, std::size_t{60}}) {  // short and long
    const Choice c = choose(Sum(gains), blocks, {readings, 2}, {1});
    std::set<std::size_t> poses;
    for (const std::size_t b : c.blocks) poses.insert(blocks[b].pose);
    EXPECT_EQ(poses.size(), 2u);
    EXPECT_EQ(c.readings.back(), readings);
  }
}

/// What is given is exchanged for what is best: one by one where readings and blocks are few, else several at a time,
/// which leaves what brings less than one part in ten thousand.
TEST(PlanChoice, ExchangesWhatItBeginsWith) {
  for (const std::size_t n : {std::size_t{30}, std::size_t{1200}}) {
    std::vector<Block> blocks;
    std::vector<double> gains;
    ChoiceOptions o;
    o.readings = n / 3;
    for (std::size_t i = 0; i < n; ++i) {
      blocks.push_back({i, 1, i % 7});
      gains.push_back(static_cast<double>((i * 7) % n + 1));
      if (i < o.readings) o.begin.push_back(i);
    }
    double best = 0;
    for (std::size_t i = 0; i < o.readings; ++i) best += static_cast<double>(n - i);
    const Choice c = choose(Sum(gains), blocks, o, {1});
    EXPECT_EQ(c.readings.back(), o.readings);
    EXPECT_GE(c.values.back(), (n == 30 ? 1 : 0.999) * best);
    o.exchange = false;
    Choice as_given = choose(Sum(gains), blocks, o, {1});
    std::sort(as_given.blocks.begin(), as_given.blocks.end());
    EXPECT_EQ(as_given.blocks, o.begin);
  }
}

/// No single exchange leaves the only pose that is allowed: all of it moves to a better one.
TEST(PlanChoice, MovesToABetterPose) {
  std::vector<Block> blocks;
  std::vector<double> gains;
  for (std::size_t i = 0; i < 60; ++i) {
    blocks.push_back({i, 1, i % 6});
    gains.push_back(static_cast<double>(1 + i % 6));
  }
  ChoiceOptions o{5, 1, true, {0, 6, 12, 18, 24}};
  const Choice c = choose(Sum(gains), blocks, o, {1});
  ASSERT_EQ(c.blocks.size(), 5u);
  for (const std::size_t b : c.blocks) EXPECT_EQ(blocks[b].pose, 5u);
}

TEST(PlanObservability, IndicesOfKnownSingularValues) {
  const VectorX sigma = (VectorX(3) << 4, 2, 1).finished();
  const MatrixX turn = Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  const MatrixX M = turn * sigma.cwiseAbs2().asDiagonal() * turn.transpose();
  const Observability o = observability(M, 9);
  EXPECT_NEAR(o.O[0], 2.0 / 3, 1e-12);  // ∛8 / √9
  EXPECT_NEAR(o.O[1], 1.0 / 4, 1e-12);
  EXPECT_NEAR(o.O[2], 1, 1e-12);
  EXPECT_NEAR(o.O[3], 1.0 / 4, 1e-12);
  EXPECT_NEAR(o.O[4], 1 / 1.75, 1e-12);
  EXPECT_NEAR(o.D_gain, 0.5 * std::log(17.0 * 5 * 2), 1e-12);
  MatrixX singular = MatrixX::Zero(3, 3);
  singular(0, 0) = 4;
  const Observability none = observability(singular, 9);
  for (const double each : none.O) EXPECT_EQ(each, 0);
  EXPECT_NEAR(none.D_gain, 0.5 * std::log(5.0), 1e-12);
}

}  // namespace
}  // namespace deflect::plan
