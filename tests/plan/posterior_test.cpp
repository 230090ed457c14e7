// Draws of what readings leave open of a rival's parameters, against sums over a grid.
#include "validation/plan/posterior.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/plan/in_one_covariance.h"
#include "validation/plan/foresight.h"
#include "validation/prediction/campaign.h"

namespace deflect::plan {
namespace {

using test::values;

/// The paper's readings of a machine with that effect, without noise, so that its values are their fit.
struct Taken {
  explicit Taken(const Rival& r, double force = 50, bool linear = false)
      : readings(filled_in(subject_with(machine(), r, r.values), prediction::campaign("paper", machine(), force, 3),
                           ForesightOptions(), linear)),
        prospect(machine(), {readings, readings.readings.size(), {}}, {}, parallel::alone),
        model(prospect, machine(), r) {}

  measurement::Measurements readings;
  Prospect prospect;
  RivalModel model;
};

TEST(PlanDraws, OfALinearLawHaveTheMeanAndTheSpreadOfItsDerivatives) {
  const Rival actuator = rival("actuator_compliance", values({2000}));
  const Taken taken(actuator);
  const Linearised fit = taken.model.at_fit();
  measurement::Random random(1);
  const MatrixX draws = draws_of(taken.model, fit, 6, random);
  EXPECT_EQ(draws(0, 0), fit.at(0));
  EXPECT_NEAR(draws.mean(), fit.at(0), 1e-12);
  const InOneCovariance one(taken.readings);
  VectorX moved = fit.at;
  moved(0) += 1e-4;
  const VectorX slope =
      (one.predicted(actuator, diagnosis::values_at(actuator.hypothesis, moved)) - fit.predicted) / 1e-4;
  const double information = one.left(slope) + 1 / taken.model.prior()(0);
  EXPECT_NEAR((draws.array() - fit.at(0)).square().mean() * information, 1, 1e-3);
}

/// A gross error counts as if it had been read as predicted.
TEST(PlanDraws, DoNotFollowAGrossError) {
  const Rival hardening = rival("actuator_hardening", values({8000, 0.003}));
  const Taken taken(hardening);
  measurement::Measurements wrong = taken.readings;
  *wrong.readings[5].displacement[2] += 1e-3;
  const Prospect prospect(machine(), {wrong, wrong.readings.size(), {}}, {}, parallel::alone);
  const RivalModel model(prospect, machine(), hardening);
  measurement::Random first(1), second(1);
  const MatrixX right = draws_of(taken.model, taken.model.at_fit(), 6, first),
                beside_it = draws_of(model, model.at_fit(), 6, second);
  EXPECT_LE((beside_it - right).norm(), 1e-6 * right.norm());
}

/// Loads that have no equilibrium in the true geometry do not stop a plan, which reckons in linear geometry.
TEST(PlanDraws, WithoutAnEquilibriumInTheTrueGeometryAreNormal) {
  const Rival hardening = rival("actuator_hardening", values({8000, 0.003}));
  const Taken taken(hardening, 1e6, true);
  EXPECT_THROW(taken.model.taken_as_linear(), std::exception) << "the test shows nothing";
  const Linearised fit = taken.model.at_fit();
  measurement::Random random(1);
  const MatrixX draws = draws_of(taken.model, fit, 6, random);
  EXPECT_LE((draws.rowwise().mean() - fit.at).norm(), 1e-9);
  EXPECT_EQ(draws.col(0), fit.at);
}

/// The sum over a grid of exp(−λ²/2): at each displacement the stiffnesses about the one that leaves least.
struct OnAGrid {
  double mean = 0;       // of ln reference
  double ends = 0;       // share of references above 0.02 mm
  double stiffness = 0;  // mean of ln stiffness

  OnAGrid(const InOneCovariance& one, const Rival& r) {
    const VectorX there = one.predicted(r, r.values);
    const auto left = [&](double ln_stiffness, double ln_reference) {
      return one.left(one.predicted(r, values({std::exp(ln_stiffness), std::exp(ln_reference)})) - there);
    };
    double sum = 0;
    const double low = std::log(1e-4), high = std::log(10.0), step = 0.5;
    for (double reference = low + step / 2; reference < high; reference += step) {
      const double least = valley(std::log(10.0), std::log(1e8), [&](double f) { return left(f, reference); });
      for (double f = least - 1; f < least + 1; f += 0.05) {
        const double weight = std::exp(-left(f, reference) / 2);
        sum += weight, mean += weight * reference, stiffness += weight * f;
        ends += reference > std::log(0.02) ? weight : 0;
      }
    }
    mean /= sum, ends /= sum, stiffness /= sum;
  }

 private:
  /// By the golden section.
  template <class Function>
  static double valley(double a, double b, const Function& f) {
    const double golden = (std::sqrt(5.0) - 1) / 2;
    while (b - a > 0.05) {
      const double c = b - golden * (b - a), d = a + golden * (b - a);
      (f(c) < f(d) ? b : a) = f(c) < f(d) ? d : c;
    }
    return (a + b) / 2;
  }
};

/// Few readings know one combination of a hardening spring's two parameters: a valley from springs that are all but
/// linear to such that hardly yield beyond their first contact.
TEST(PlanDraws, OfALawThatBendsAreThoseOfAGrid) {
  const Rival hardening = rival("actuator_hardening", values({8000, 0.003}));
  const Taken taken(hardening);
  const OnAGrid expected(InOneCovariance(taken.readings), hardening);
  measurement::Random random(1);
  const MatrixX draws = draws_of(taken.model, taken.model.at_fit(), 400, random);
  const double deviation = std::sqrt((draws.row(1).array() - draws.row(1).mean()).square().mean());
  EXPECT_GT(deviation, 1) << "the test shows nothing";
  const double effective = 200;  // of 400 proposals
  const double ends = (draws.row(1).array() > std::log(0.02)).cast<double>().mean();
  EXPECT_NEAR(ends, expected.ends, 3 * std::sqrt(0.25 / effective));
  EXPECT_NEAR(draws.row(1).mean(), expected.mean, 3 * deviation / std::sqrt(effective));
  EXPECT_NEAR(draws.row(0).mean(), expected.stiffness,
              3 * std::sqrt((draws.row(0).array() - draws.row(0).mean()).square().mean() / effective));
}

}  // namespace
}  // namespace deflect::plan
