// Two effects at once, on signatures made by hand.
#include "validation/diagnosis/pairs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/effects.h"
#include "validation/measurement/random.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/evidence.h"

namespace deflect {
namespace {

using namespace diagnosis;

constexpr Eigen::Index numbers = 12;

VectorX axis(Eigen::Index i) { return VectorX::Unit(numbers, i); }

Signature signature(const MatrixX& basis, bool shaped = false, bool one_sided = false) {
  Signature s;
  s.effect = {&test::effect("modulus"), {}};
  s.basis = basis;
  s.start = VectorX::Unit(basis.cols(), 0);
  s.lambda = 1;
  s.shaped = shaped;
  s.one_sided = one_sided;
  return s;
}

/// Odds without a prior: all effects are alike.
std::vector<PairOfSignatures> pairs(const std::vector<Signature>& all, const VectorX& residual,
                                    const MatrixX& beside = MatrixX(numbers, 0), double least = -1e6,
                                    std::size_t most = 3) {
  const auto odds = [&](std::size_t i, double gain) {
    return statistics::log_evidence(gain, all[i].amplitudes(), all[i].one_sided);
  };
  return best_pairs(all, inner_products(all), residual, beside, odds, least, most);
}

// Two effects of λ = 10 each. A third that lies halfway explains 200 · cos² 20° = 177 of 200, either of the two 100:
// taken one after the other the third comes first, and what it leaves is shared by no single one. Both together explain
// all.
TEST(Pairs, FindTwoThatAThirdResembles) {
  const VectorX halfway = (axis(0) + axis(1)).normalized() * std::cos(0.349) + axis(2) * std::sin(0.349);
  const std::vector<Signature> all = {signature(axis(0)), signature(axis(1)), signature(halfway)};
  const std::vector<PairOfSignatures> best = pairs(all, 10 * axis(0) + 10 * axis(1));
  ASSERT_FALSE(best.empty());
  EXPECT_EQ(best.front().first + best.front().second, 1u);
  EXPECT_NEAR(best.front().gain_of_first, 100, 1e-9);
  EXPECT_NEAR(best.front().gain, 200, 1e-9);
}

// Against least squares over the columns of each pair, for effects of one, two and three directions beside a fit.
TEST(Pairs, GainIsThatOfLeastSquares) {
  measurement::Random random(3);
  const auto lot = [&](Eigen::Index columns) {
    MatrixX out(numbers, columns);
    for (Eigen::Index i = 0; i < out.size(); ++i) out(i) = random.normal();
    return statistics::orthonormal(out);
  };
  std::vector<Signature> all = {signature(lot(1)), signature(lot(2)), signature(lot(1)), signature(lot(3))};
  const MatrixX beside = lot(2);
  VectorX residual = 30 * lot(1);
  residual -= beside * (beside.transpose() * residual);
  const std::vector<PairOfSignatures> found = pairs(all, residual, beside, -1e6, 6);
  EXPECT_GE(found.size(), 3u);
  for (const PairOfSignatures& p : found) {
    const auto gain = [&](const std::vector<MatrixX>& of) {
      MatrixX columns = statistics::side_by_side(of, numbers);
      columns -= beside * (beside.transpose() * columns);
      return (statistics::orthonormal(columns).transpose() * residual).squaredNorm();
    };
    EXPECT_NEAR(p.gain_of_first, gain({all[p.first].basis}), 1e-9);
    EXPECT_NEAR(p.gain, gain({all[p.first].basis, all[p.second].basis}), 1e-9);
    EXPECT_GE(p.gain_of_first, gain({all[p.second].basis}));
  }
}

// The second would have to act the other way: the residual asks for +, and what changes it by + of its column explains
// −.
TEST(Pairs, ActTheWayThatPhysicsLets) {
  const VectorX residual = -10 * axis(0) + 10 * axis(1);
  const std::vector<Signature> both_ways = {signature(axis(0)), signature(axis(1))};
  EXPECT_EQ(pairs(both_ways, residual).size(), 1u);
  std::vector<Signature> one_way = {signature(axis(0)), signature(axis(1), false, true)};
  EXPECT_TRUE(pairs(one_way, residual).empty());
  one_way[1].start(0) = -1;  // its change at the start is −: it explains +
  EXPECT_EQ(pairs(one_way, residual).size(), 1u);
}

// Of a shaped effect only one column applies at a time: axes 1 and 2 are no plane that it could fill.
TEST(Pairs, OfAShapedEffectOneShapeAtATime) {
  MatrixX shapes(numbers, 2);
  shapes << axis(1), axis(2);
  const VectorX residual = 10 * axis(0) + 10 * axis(1) + 8 * axis(2);
  const std::vector<PairOfSignatures> found = pairs({signature(axis(0)), signature(shapes, true)}, residual);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found.front().gain, 200, 1e-9);
}

TEST(Pairs, NeitherWhatIsThereNorTwoThatAreOneNorThoseTooUnlikely) {
  const VectorX residual = 10 * axis(0) + 10 * axis(1);
  const std::vector<Signature> all = {signature(axis(0)), signature(axis(1))};
  EXPECT_TRUE(pairs(all, 10 * axis(0), axis(1)).empty());
  EXPECT_TRUE(pairs({all[0], all[0]}, residual).empty());
  const double odds = 2 * statistics::log_evidence(100, 1, false);
  EXPECT_EQ(pairs(all, residual, MatrixX(numbers, 0), odds - 1e-6).size(), 1u);
  EXPECT_TRUE(pairs(all, residual, MatrixX(numbers, 0), odds + 1e-6).empty());
}

}  // namespace
}  // namespace deflect
