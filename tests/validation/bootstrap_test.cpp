// The chance that some effect looks as good in data with nothing missing, against what statistics says of it.
#include "validation/diagnosis/bootstrap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/thread_ranks.h"

namespace deflect {
namespace {

using namespace diagnosis;
using namespace parallel;

constexpr Eigen::Index rows = 12;

/// An effect of the directions e_from … of the data, as many as asked for.
Signature along_axes(Eigen::Index from, Eigen::Index count = 1) {
  Signature s;
  s.basis = MatrixX::Zero(rows, count);
  for (Eigen::Index i = 0; i < count; ++i) s.basis(from + i, i) = 1;
  s.start = VectorX::Unit(s.basis.cols(), 0);
  s.lambda = 1;
  return s;
}

Signature to_one_side(Signature s) {
  s.one_sided = true;
  return s;
}

double chance(const std::vector<Signature>& all, double p, int sets = 100'000) {
  return chance_of_any(all, inner_products(all), p, sets, {});
}

/// Five standard deviations of a share of that many draws.
double scatter(double p, int sets = 100'000) { return 5 * std::sqrt(p * (1 - p) / sets) + 1.0 / sets; }

TEST(Bootstrap, OneEffectAloneHasItsPValue) {
  for (const double p : {0.5, 0.05, 0.002}) {
    EXPECT_NEAR(chance({along_axes(0)}, p), p, scatter(p));
    EXPECT_NEAR(chance({along_axes(2, 3)}, p), p, scatter(p)) << "three amplitudes";
    EXPECT_NEAR(chance({to_one_side(along_axes(1))}, p), p, scatter(p)) << "one-sided";
  }
}

TEST(Bootstrap, ManyLooksRaiseTheChance) {
  std::vector<Signature> all;
  for (Eigen::Index i = 0; i < 8; ++i) all.push_back(along_axes(i));
  const double p = 0.01, any = 1 - std::pow(1 - p, 8);
  EXPECT_NEAR(chance(all, p), any, scatter(any)) << "eight independent effects";
  EXPECT_NEAR(chance({all[0], all[0], all[0]}, p), p, scatter(p)) << "the same effect under three names";
}

/// Of the directions of a shaped effect the best counts, judged as one: 1 − (1 − p)ⁿ of n orthogonal ones.
TEST(Bootstrap, AShapedEffectTakesItsBestShape) {
  Signature s = along_axes(0, 4);
  s.shaped = true;
  const double p = 0.02, any = 1 - std::pow(1 - p, 4);
  EXPECT_NEAR(chance({s}, p), any, scatter(any));
}

TEST(Bootstrap, IsResolvedToTheNumberOfSets) {
  EXPECT_EQ(chance({along_axes(0)}, 1e-12, 999), 1e-3);
  EXPECT_EQ(chance({along_axes(0)}, 0, 99), 1e-2);
  EXPECT_EQ(chance({along_axes(0)}, 1, 99), 1);
  EXPECT_EQ(chance({}, 0.1, 99), 1);
}

TEST(Bootstrap, IsTheSameForAnyNumberOfThreadsAndRanks) {
  const std::vector<Signature> all = {along_axes(0), along_axes(3, 2), to_one_side(along_axes(7))};
  const MatrixX inner = inner_products(all);
  const double alone = chance_of_any(all, inner, 0.05, 12'345, {1});
  EXPECT_EQ(chance_of_any(all, inner, 0.05, 12'345, {3}), alone);
  for (const int size : {2, 3})
    test::ThreadRanks(size).run([&](Ranks& ranks) {
      EXPECT_EQ(chance_of_any(all, inner, 0.05, 12'345, {1, &ranks}), alone) << "rank " << ranks.rank();
    });
}

}  // namespace
}  // namespace deflect
