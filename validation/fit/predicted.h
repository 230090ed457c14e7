// What readings will be, with intervals: prediction of a plan of poses and loads.
//
//   y = f(x, p̂) + P δ + A η + s + l + c S w + ε
//
//   f      a theory's prediction in the geometry in which equilibrium really is, at the fitted parameters
//   δ, η   deviations of parameters, and tolerances common to all poses, jointly normal as the fit left them
//          (posterior.h); without a fit η ~ N(0, 1)
//   s      errors of the pose: A of its own tolerances
//   l      errors of the loads (load_errors.h)
//   c      discrepancy as a share of the size S of the reading's predictions of that quantity (Discrepancy)
//   ε      noise of one reading
// with w ~ N(0, 1). The mean has what the fit learnt of η. Variances add up; that of P δ + A η is told in two parts,
// var(A η | δ) as that of the tolerances and the rest as that of the parameters. Unknown zeros of sensors do not count.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/fit/fit_file.h"
#include "validation/statistics/parted_columns.h"

namespace deflect::fit {

struct Shares {
  double parameters = 0, tolerances = 0, load = 0, discrepancy = 0, noise = 0;  ///< standard deviations, SI

  double of_prediction() const;  ///< without noise
  double of_reading() const;
};

struct PredictedNumber {
  std::size_t reading = 0, channel = 0;
  measurement::Quantity quantity = measurement::Quantity::length;
  std::vector<double> by_theory;  ///< in the order of PredictedPlan::theories
  double value = 0;               ///< mean
  Shares deviation;
  double low = 0, high = 0;  ///< 95 % interval of a reading
};

struct PredictedPlan {
  std::string device;
  measurement::Measurements plan;  ///< with the mean as its readings
  theories::Theories theories;     ///< the first gives the mean; of a frame the MSA alone
  bool fitted = false;
  bool noise_known = true;  ///< for every number
  std::vector<PredictedNumber> numbers;
  /// Root of the covariance of P δ + A η + s over the numbers: columns times their transpose; groups: poses.
  statistics::PartedColumns errors;
  /// Quantities that the fit did not read: their discrepancy is the largest share of those that it read.
  std::vector<measurement::Quantity> discrepancy_of_others = {};
};

struct PredictedPlanOptions {
  theories::Theories theories = theories::all_theories();
  std::optional<double> sigma_u, sigma_th;  ///< of a reading, where neither sensor nor fit tell it
  bool tool_point = false;                  ///< of a machine with named sensors the displacement of T as well
  std::vector<Discrepancy> discrepancies;   ///< in place of those of the fit, where there are any
};

/// Throws as Standing::predict() does.
PredictedPlan predict(const subject::Subject&, const measurement::Measurements& plan,
                      const std::optional<Knowledge>& = {}, const PredictedPlanOptions& = {},
                      const parallel::Work& = {});

}  // namespace deflect::fit
