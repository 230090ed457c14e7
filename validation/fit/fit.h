// Fits parameters that a user chooses to measurements. Tolerances are nuisances under their priors, readings have noise
// (Observations); a tolerance of the same number as a free parameter gives way to it.
//
// Least squares of the whitened residual, with a row for each prior, by Levenberg–Marquardt (hypothesis.h) from the
// values of the description. The deformed shape, gross outliers and the size of tolerances are then judged anew by the
// fitted subject, and the fit is repeated. Intervals are those of the posterior (posterior.h), symmetric in the
// coordinate of each parameter and cut where the description's bounds are.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/diagnosis/diagnosis.h"
#include "validation/fit/posterior.h"
#include "validation/fit/undetermined.h"

namespace deflect::fit {

struct FittedParameter : FreeParameter {
  double first = 0;                 ///< SI: the first number that it moves, in the description that was fitted
  double fitted = 0;                ///< SI; a common factor on the description that was fitted
  double deviation = 0;             ///< posterior standard deviation of the coordinate
  double low = 0, high = 0;         ///< 95 % interval, SI
  std::optional<double> pull = {};  ///< standard deviations of the prior from its mean
  std::optional<double> beyond_tolerance = {};  ///< of the declared tolerance of that number, without a prior
};

struct FitResult {
  std::string device, data;
  std::vector<std::string> how_read;
  std::vector<FittedParameter> parameters;
  MatrixX correlation;
  std::vector<Undetermined> undetermined;
  bool converged = true;      ///< what is left to go is small, but for parameters at a bound that would leave it
  diagnosis::Quality before;  ///< held-out as in `compare`
  diagnosis::Quality after;   ///< held-out with parameters fitted without the pose
  /// Of the whitened numbers, priors apart. Before: as in `diagnose`, with all tolerances as declared; after: without
  /// those that free parameters take the place of.
  double chi2_before = 0, chi2_after = 0;
  std::size_t readings = 0, poses = 0, numbers = 0, set_aside = 0;
  measurement::Quantity quantity = measurement::Quantity::length;  ///< of errors
  double noise_and_tolerances = 0;                                 ///< root mean square expected with nothing missing
  double tolerance_scale = 1;
  double p_value = 1;                 ///< of so large a χ² by chance, after the fit
  std::vector<std::string> findings;  ///< patterns that the fitted subject leaves, in sentences
  std::vector<std::pair<std::string, double>> strained;
  std::vector<std::string> tolerances;  ///< names of η in the posterior; the last is the deformed shape
  Posterior posterior;
  std::vector<Discrepancy> discrepancies;
  /// Root mean square of σ by quantity, of what was measured.
  std::vector<std::pair<measurement::Quantity, double>> sigma;
};

/// Misfit after the fit that chance gives less often than this is significant.
inline constexpr double significant_misfit = 1e-3;

/// Values that the fit found, SI, by parameter.
VectorX fitted_values(const FitResult&);

/// Throws InputError for a file with a certain recording mistake (unless as_recorded), and as compare() does;
/// NumericalError where the subject cannot be predicted at any value.
FitResult fit(const subject::Subject&, const measurement::Measurements&, const std::vector<FreeParameter>&,
              const compare::ComparisonOptions& = {}, const parallel::Work& = {});

}  // namespace deflect::fit
