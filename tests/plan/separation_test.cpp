// By how much a plan expects readings to tell two effects apart, against regressions and fits that share only the
// predictions with it.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "tests/plan/rivals_on_the_6psu.h"
#include "validation/diagnosis/fit_problem.h"
#include "validation/measurement/joined.h"
#include "validation/plan/foresight.h"
#include "validation/plan/next_readings.h"
#include "validation/prediction/campaign.h"
#include "validation/statistics/columns.h"

namespace deflect::plan {
namespace {

using measurement::Measurements;
using test::values;

Measurements as_predicted(const char* campaign) {
  return filled_in(machine(), prediction::campaign(campaign, machine(), 50, 3), ForesightOptions(), true);
}

/// What the machine with a rival is predicted to read, with all readings, their noise and all tolerances in one
/// covariance.
class InOneCovariance {
 public:
  explicit InOneCovariance(const Measurements& all) : all_(all), read_(measurement::measured_values(all)) {
    const auto standing = subject_.stand(all_);
    std::vector<double> sigma;
    for (const measurement::MeasuredValue& v : read_) sigma.push_back(*v.sigma);
    uncertainty_.emplace(statistics::tolerance_model(*standing, all_, read_).A, read_, sigma,
                         standing->predict(all_, linear()), subject_.load_tolerance());
  }

  VectorX predicted(const Rival& r, const VectorX& at) const {
    const auto standing = subject_with(subject_, r, at).stand(all_);
    return statistics::rows_of(read_, standing->predict(all_, linear(), parallel::alone));
  }

  /// λ² between two rivals where the fitted one is linear about its values.
  double by_regression(const Rival& truth, const Rival& fitted) const {
    const VectorX here = predicted(fitted, fitted.values);
    const VectorX x = diagnosis::coordinates_of(fitted.hypothesis, fitted.values);
    MatrixX G(here.size(), x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      VectorX moved = x;
      moved(i) += 1e-4;
      G.col(i) = (predicted(fitted, diagnosis::values_at(fitted.hypothesis, moved)) - here) / 1e-4;
    }
    const VectorX difference = predicted(truth, truth.values) - here;
    return left(difference) - statistics::regress(*uncertainty_, difference, G).gain;
  }

  /// The same where it is fitted by steps to either side, halved where none leaves less. Each logarithm of its values
  /// has the prior deviation 3 about those given.
  double by_steps(const Rival& truth, const Rival& fitted) const { return search(truth, fitted).first; }
  /// So fitted.
  Rival fitted_by_steps(const Rival& truth, Rival fitted) const {
    fitted.values = diagnosis::values_at(fitted.hypothesis, search(truth, fitted).second);
    return fitted;
  }

 private:
  static prediction::PredictionOptions linear() {
    prediction::PredictionOptions o;
    o.geometry = Geometry::linear;
    return o;
  }

  std::pair<double, VectorX> search(const Rival& truth, const Rival& fitted) const {
    const VectorX y = predicted(truth, truth.values);
    const VectorX begun = diagnosis::coordinates_of(fitted.hypothesis, fitted.values);
    const auto left_at = [&](const VectorX& x) {
      return left(y - predicted(fitted, diagnosis::values_at(fitted.hypothesis, x))) + ((x - begun) / 3).squaredNorm();
    };
    std::pair<double, VectorX> best = {left_at(begun), begun};
    for (double step = 1; step > 1e-3;) {
      const double before = best.first;
      for (Eigen::Index i = 0; i < begun.size(); ++i)
        for (const double by : {step, -step}) {
          VectorX moved = best.second;
          moved(i) += by;
          if (const double there = left_at(moved); there < best.first) best = {there, moved};
        }
      if (best.first == before) step /= 2;
    }
    return best;
  }

  double left(const VectorX& r) const { return uncertainty_->inner(r, r)(0, 0); }

  subject::Subject subject_ = machine();
  Measurements all_;
  std::vector<measurement::MeasuredValue> read_;
  std::optional<statistics::Uncertainty> uncertainty_;
};

TEST(PlanSeparation, IsThatOfARegressionOnEverythingThatWasRead) {
  PlanOptions o;
  o.draws = 1;
  const Rival actuator = rival("actuator_compliance", values({2000})),
              platform = rival("platform_flexibility", values({1500}));
  const Measurements paper = as_predicted("paper"), rich = as_predicted("random");
  const InOneCovariance all(measurement::joined({paper, rich})), before(paper);
  const auto added = [&](const Rival& truth, const Rival& fitted) {
    return all.by_regression(truth, fitted) - before.by_regression(truth, fitted);
  };
  const double mean = (added(actuator, platform) + added(platform, actuator)) / 2;
  const Step step = expected_of(machine(), paper, rich, {actuator, platform}, o);
  ASSERT_EQ(step.pairs.size(), 1u);
  // The prior of a stiffness, e³ wide, stands in the plan and not in the regression.
  EXPECT_NEAR(step.pairs.front().separation, mean, 0.01 * mean);
}

/// A spring that hardens, fitted to readings of play: its derivatives say more than it can do.
TEST(PlanSeparation, WhereALawBendsTheRivalIsFittedToTheEnd) {
  PlanOptions o;
  o.draws = 1;
  const Measurements paper = as_predicted("paper"), more = as_predicted("cycle");
  const InOneCovariance all(measurement::joined({paper, more})), before(paper);
  const Rival play = rival("joint_clearance", values({0.001})),
              hardening = before.fitted_by_steps(play, rival("actuator_hardening", values({30000, 0.001})));
  const double bent = all.by_steps(play, hardening) - before.by_steps(play, hardening);
  // Gaps are linear in their readings.
  const double back = all.by_regression(hardening, play) - before.by_regression(hardening, play);
  const Step step = expected_of(machine(), paper, more, {play, hardening}, o);
  EXPECT_NEAR(step.pairs.front().separation, (bent + back) / 2, 0.02 * (bent + back) / 2);
  const double linear = all.by_regression(play, hardening) - before.by_regression(play, hardening);
  EXPECT_GT(std::abs(linear / bent - 1), 0.1) << linear << ' ' << bent;  // else the test shows nothing
}

/// A platform that hardly yields has no derivatives that lead to one that yields as much as actuators do.
TEST(PlanSeparation, ARivalFarFromItsFitIsFound) {
  PlanOptions o;
  o.draws = 1;
  const Measurements paper = as_predicted("paper"), more = as_predicted("cycle");
  const InOneCovariance all(measurement::joined({paper, more})), before(paper);
  const Rival actuator = rival("actuator_compliance", values({500})),
              platform = rival("platform_flexibility", values({3e5}));
  const auto added = [&](const Rival& truth, const Rival& fitted) {
    return all.by_steps(truth, fitted) - before.by_steps(truth, fitted);
  };
  const Pair found = expected_of(machine(), paper, more, {actuator, platform}, o).pairs.front();
  EXPECT_NEAR(found.if_a, added(actuator, platform), 0.5 + 0.02 * found.if_a);
  EXPECT_NEAR(found.if_b, added(platform, actuator), 0.5 + 0.02 * found.if_b);
}

}  // namespace
}  // namespace deflect::plan
