// Readings of the 6-PSU in one covariance: fits that share only the predictions with a plan.
#pragma once

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "tests/plan/rivals_on_the_6psu.h"
#include "validation/diagnosis/fit_problem.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/uncertainty.h"

namespace deflect::plan {

/// What the machine with a rival is predicted to read, with all readings, their noise and all tolerances in one
/// covariance.
class InOneCovariance {
 public:
  explicit InOneCovariance(const measurement::Measurements& all) : all_(all), read_(measurement::measured_values(all)) {
    const auto standing = subject_.stand(all_);
    std::vector<double> sigma;
    for (const measurement::MeasuredValue& v : read_) sigma.push_back(*v.sigma);
    uncertainty_.emplace(statistics::tolerance_model(*standing, all_, read_).A, read_, sigma,
                         statistics::LoadErrors(subject_.load_tolerance(), standing->predict(all_, linear())));
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

  /// λ² that noise and tolerances leave.
  double left(const VectorX& r) const { return uncertainty_->inner(r, r)(0, 0); }

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

  subject::Subject subject_ = machine();
  measurement::Measurements all_;
  std::vector<measurement::MeasuredValue> read_;
  std::optional<statistics::Uncertainty> uncertainty_;
};

}  // namespace deflect::plan
