// Signatures by their definitions: gains by least squares, sizes by proportion, weights and p-values by their words.
#include "validation/diagnosis/signatures.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <numeric>

#include "msa/base/index.h"
#include "tests/support/effects.h"
#include "validation/diagnosis/bootstrap.h"
#include "validation/measurement/random.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/tail.h"

namespace deflect::diagnosis {
namespace {

MatrixX noise(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  measurement::Random random(seed);
  MatrixX out(rows, columns);
  for (double& x : out.reshaped()) x = random.normal();
  return out;
}

Signature of_amplitudes(const MatrixX& changes) {
  Signature s;
  s.basis = statistics::orthonormal(changes);
  s.start = s.basis.transpose() * changes.rowwise().sum();
  s.lambda = s.start.norm();
  return s;
}

Signature of_shapes(const MatrixX& changes) {
  Signature s;
  s.basis = changes.colwise().normalized();
  s.shaped = true;
  return s;
}

/// What χ² of r falls by when X is fitted to it beside B, less by B alone.
double gain_by_least_squares(const MatrixX& X, const MatrixX& B, const VectorX& r) {
  MatrixX both(r.size(), X.cols() + B.cols());
  both << X, B;
  const auto left = [&](const MatrixX& A) {
    if (A.cols() == 0) return r.squaredNorm();
    const Eigen::ColPivHouseholderQR<MatrixX> qr(A);
    return VectorX(r - A * qr.solve(r)).squaredNorm();
  };
  return left(B) - left(both);
}

TEST(Signatures, GainByAllAmplitudesBesideWhatIsFitted) {
  const MatrixX X = noise(30, 3, 1), B = noise(30, 2, 2);
  const MatrixX fitted = statistics::orthonormal(B);
  VectorX r = noise(30, 1, 3) + 3 * X.col(1);
  r -= fitted * (fitted.transpose() * r);
  const Signature s = of_amplitudes(X);
  EXPECT_NEAR(most_gain(s, r, fitted), gain_by_least_squares(X, B, r), 1e-9 * r.squaredNorm());
  EXPECT_NEAR(most_gain(s, r, MatrixX(30, 0)), gain_by_least_squares(X, MatrixX(30, 0), r), 1e-9 * r.squaredNorm());
}

TEST(Signatures, GainByTheBestShapeAndNotAgainstItsSense) {
  const MatrixX X = noise(30, 3, 4), B = noise(30, 2, 5);
  const MatrixX fitted = statistics::orthonormal(B);
  for (const double sense : {-1.0, 1.0}) {
    VectorX r = noise(30, 1, 6) + sense * 4 * X.col(2);
    r -= fitted * (fitted.transpose() * r);
    Signature s = of_shapes(X);
    double best = 0, against = 0;  // an effect takes a residual away that is opposite to its change
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double gain = gain_by_least_squares(X.col(i), B, r);
      best = std::max(best, gain);
      const VectorX own = X.col(i) - fitted * (fitted.transpose() * X.col(i));
      if (own.dot(r) <= 0) against = std::max(against, gain);
    }
    EXPECT_NEAR(most_gain(s, r, fitted), best, 1e-9 * r.squaredNorm());
    s.one_sided = true;
    EXPECT_NEAR(most_gain(s, r, fitted), against, 1e-9 * r.squaredNorm());
  }
  // What the others leave a thousandth of says nothing: rounding would.
  const Signature same = of_shapes(fitted.col(0) + 5e-4 * noise(30, 1, 7).normalized());
  EXPECT_EQ(most_gain(same, noise(30, 1, 8), fitted), 0);
  const Signature nearly = of_shapes(fitted.col(0) + 1.5e-3 * noise(30, 1, 7).normalized());
  EXPECT_GT(most_gain(nearly, noise(30, 1, 8), fitted), 0);
}

TEST(Signatures, ShareOutsideWhatIsFittedIsTheSineOfTheAngle) {
  MatrixX B = MatrixX::Zero(5, 1);
  B(0, 0) = 1;
  for (const double angle : {0.0, 0.3, 1.0, M_PI / 2}) {
    MatrixX X = MatrixX::Zero(5, 1);
    X(0, 0) = std::cos(angle), X(3, 0) = std::sin(angle);
    EXPECT_NEAR(own_share(of_amplitudes(X), B), std::sin(angle), 1e-12);
    EXPECT_NEAR(cosine(of_amplitudes(X), of_amplitudes(B)), std::cos(angle), 1e-12);
  }
  MatrixX two = MatrixX::Zero(5, 2);  // one within, one outside: the root of the mean square
  two(0, 0) = 1, two(4, 1) = 1;
  EXPECT_NEAR(own_share(of_amplitudes(two), B), std::sqrt(0.5), 1e-12);
  EXPECT_EQ(own_share(of_amplitudes(two), MatrixX(5, 0)), 1);
}

// More rows than are multiplied at once.
TEST(Signatures, InnerProductsAndCosinesAreThoseOfAllColumns) {
  const std::vector<Signature> all = {of_amplitudes(noise(5000, 2, 9)), of_shapes(noise(5000, 3, 10)),
                                      of_shapes(noise(5000, 1, 11)), of_amplitudes(noise(5000, 1, 12))};
  MatrixX X(5000, 7);
  X << all[0].basis, all[1].basis, all[2].basis, all[3].basis;
  EXPECT_LT((inner_products(all) - X.transpose() * X).cwiseAbs().maxCoeff(), 1e-12);
  const MatrixX between = cosines(all, inner_products(all));
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = 0; k < all.size(); ++k)
      EXPECT_NEAR(between(as_index(i), as_index(k)), cosine(all[i], all[k]), 1e-12);
  // Of a shape and a plane: the angle between the line and the plane.
  double most = 0;
  for (const auto column : all[1].basis.colwise()) most = std::max(most, (all[0].basis.transpose() * column).norm());
  EXPECT_NEAR(between(0, 1), most, 1e-12);
  EXPECT_NEAR(between(1, 0), most, 1e-12);
  EXPECT_EQ(inner_products({}).size(), 0);
}

// More columns than a thread takes at once.
TEST(Signatures, InnerProductsAreTheSameWhateverTheThreads) {
  std::vector<Signature> all;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) all.push_back(of_shapes(noise(300, 3, seed)));
  const MatrixX alone = inner_products(all);
  MatrixX X(300, 150);
  for (std::size_t i = 0; i < all.size(); ++i) X.middleCols(3 * as_index(i), 3) = all[i].basis;
  EXPECT_LT((alone - X.transpose() * X).cwiseAbs().maxCoeff(), 1e-12);
  for (const int threads : {2, 5}) EXPECT_EQ(inner_products(all, threads), alone);
}

// All laws at places together weigh half as much as the entries, and none more than an entry.
TEST(Signatures, LawsAtPlacesTogetherWeighHalfAsMuchAsTheEntries) {
  effects::Effect place = test::effect("modulus");
  place.place.emplace();
  const auto weights = [&](int entries, int places) {
    std::vector<Signature> all;
    for (int i = 0; i < entries; ++i) all.emplace_back().effect = {&test::effect("modulus"), {}};
    for (int i = 0; i < places; ++i) all.emplace_back().effect = {&place, {}};
    return weights_of(all);
  };
  EXPECT_EQ(weights(2, 0), std::vector<double>(2, 1));
  EXPECT_EQ(weights(0, 3), std::vector<double>(3, 1));
  const std::vector<double> many = weights(20, 60), few = weights(20, 2);
  EXPECT_EQ(many[0], 1);
  EXPECT_NEAR(many[25], 0.5 * 20 / 60, 1e-15);
  EXPECT_NEAR(std::accumulate(many.begin() + 20, many.end(), 0.0), 0.5 * 20, 1e-12);
  EXPECT_EQ(few[21], 1);
}

// A law in one leg weighs in six legs together as much as one in all legs alike, and its prior is the same.
TEST(Signatures, ALawInOneLegWeighsAsOneInAllLegs) {
  effects::Effect every = test::effect("modulus"), one = test::effect("leg_defect");
  every.place.emplace(), one.place.emplace();
  every.name = "clearance@elbow.rz", one.name = "clearance@leg.elbow.rz";
  std::vector<Signature> all(3);
  all[0].effect = {&test::effect("modulus"), {}}, all[1].effect = {&test::effect("self_weight"), {}};
  all[2].effect = {&every, {}};
  for (int leg = 1; leg <= 6; ++leg) all.emplace_back().effect = {&one, leg};
  const std::vector<double> weights = weights_of(all);
  EXPECT_NEAR(weights[2], 0.5 * 2 / 2, 1e-15);
  for (std::size_t i = 3; i < all.size(); ++i) EXPECT_NEAR(weights[i], weights[2] / 6, 1e-15);
  std::vector<std::size_t> classes(all.size());
  std::iota(classes.begin(), classes.end(), std::size_t{0});
  const std::vector<double> priors = shared_priors(all, classes, 0.7);
  EXPECT_NEAR(std::accumulate(priors.begin() + 3, priors.end(), 0.0), priors[2], 1e-15);
  EXPECT_NEAR(priors[2] / priors[0], 0.5, 1e-12);
}

/// With one parameter from `low` to `high` that starts at `start`.
effects::Effect with_parameter(double start, double vanishes, double low, double high, bool log) {
  effects::Effect e = test::effect("modulus");
  effects::EffectParameter& p = e.parameters.front();
  p.start = start, p.vanishes = vanishes, p.low = low, p.high = high, p.log = log;
  return e;
}

// The change at the start value is (1, 2, 0, …); the effect that takes a residual of −k of it away is k times as large.
TEST(Signatures, GuessIsInProportion) {
  VectorX change = VectorX::Zero(6);
  change(0) = 1, change(1) = 2;
  const auto guessed = [&](const effects::Effect& e, double times) {
    Signature s = of_amplitudes(change);
    s.effect = {&e, {}};
    return guess(s, VectorX(-times * change + VectorX::Unit(6, 5)));
  };
  const effects::Effect linear = with_parameter(0.5, 0.2, -10, 10, false);
  EXPECT_NEAR((*guessed(linear, 3))(0), 0.2 + 3 * 0.3, 1e-12);
  EXPECT_NEAR((*guessed(linear, -2))(0), 0.2 - 2 * 0.3, 1e-12);
  EXPECT_EQ((*guessed(linear, 1000))(0), 10);
  // A stiffness: the compliance is in proportion, and has no other sign.
  const effects::Effect spring = with_parameter(500, std::numeric_limits<double>::infinity(), 1, 1e6, true);
  EXPECT_NEAR((*guessed(spring, 4))(0), 125, 1e-9);
  EXPECT_FALSE(guessed(spring, -4));
  // A factor that would be negative stands at its end.
  const effects::Effect factor = with_parameter(1.1, 1, 0.3, 3, true);
  EXPECT_NEAR((*guessed(factor, 2))(0), 1.2, 1e-12);
  EXPECT_EQ((*guessed(factor, -20))(0), 0.3);
  effects::Effect open = linear;
  open.parameters.front().vanishes.reset();
  EXPECT_FALSE(guessed(open, 1));
  EXPECT_FALSE(guessed(test::effect("base_compliance"), 1));  // two parameters
}

TEST(Signatures, PValuesOfOneEffectAndBack) {
  Signature one = of_amplitudes(noise(20, 1, 13)), three = of_amplitudes(noise(20, 3, 14));
  EXPECT_NEAR(single_p_value(one, 3.841459), 0.05, 1e-6);
  EXPECT_NEAR(single_p_value(three, 7.814728), 0.05, 1e-6);
  EXPECT_EQ(single_p_value(one, 0), 1);
  for (const double p : {0.3, 0.01, 1e-6}) EXPECT_NEAR(single_p_value(three, gain_at_p_value(three, p)), p, 1e-9 * p);
  one.one_sided = true;  // half of chance is on the other side
  EXPECT_NEAR(single_p_value(one, 3.841459), 0.025, 1e-6);
  EXPECT_NEAR(single_p_value(one, gain_at_p_value(one, 0.01)), 0.01, 1e-9);
  EXPECT_EQ(gain_at_p_value(one, 0.6), 0);
}

}  // namespace
}  // namespace deflect::diagnosis
