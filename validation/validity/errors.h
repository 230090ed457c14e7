// Comparison errors of single readings and their validation uncertainty, in the words of ASME V&V 20-2009 (Standard for
// Verification and Validation in Computational Fluid Dynamics and Heat Transfer), section 1:
//   E = S − D,   u_val² = u_num² + u_input² + u_D²,   the error of the model lies in E ± k u_val
//   S        simulated value, D datum
//   u_num    numerical: by a study of the mesh (numerical.h)
//   u_input  inputs of the simulation: tolerances and, of a calibrated model, parameters as the calibration left them
//   u_D      data: noise of a reading, and the load cell
// Where |E| ≤ k u_val the error of the model cannot be told from zero; where |E| is far above, E is that error.
//
// All numbers at once, with the correlations that tolerances make (multivariate metric of ASME VVUQ 20.1):
//   χ² = Eᵀ V⁻¹ E,   V = covariance of what u_val is made of,
// which is χ² distributed with as many degrees of freedom as numbers where the model is right.
#pragma once

#include <memory>
#include <vector>

#include "validation/compare/comparison.h"
#include "validation/fit/predicted.h"

namespace deflect::validity {

struct ComparisonError {
  double S = 0, D = 0;  ///< SI; D from its zero, where the zero of the sensor is unknown
  double num = 0, input = 0, noise = 0, load = 0;

  double E() const { return S - D; }
  double u_D() const;
  double u_val() const;
};

/// Coverage factor: 95 % of a normal distribution.
inline constexpr double coverage_factor = 2;

struct Agreement {
  double chi2 = 0;
  std::size_t numbers = 0;
  double p_value = 1;
};

class Errors {
 public:
  /// `plan`: predicted under the loads of the comparison's data, which must outlive this, as must the comparison.
  /// `numerical`: u_num by its numbers; none: zero.
  Errors(const compare::Comparison&, const fit::PredictedPlan& plan, const std::vector<double>& numerical);

  const std::vector<ComparisonError>& all() const { return errors_; }  ///< by measured number
  const compare::Comparison& comparison() const { return *comparison_; }
  const std::vector<bool>& aside() const { return aside_; }  ///< by reading: gross outliers
  bool counts(std::size_t number) const;                     ///< not set aside

  /// Of the readings not set aside; `without`: by reading, left out as well.
  Agreement agreement(const std::vector<bool>& without = {}) const;
  /// Of one channel's numbers alone.
  Agreement agreement_of_channel(std::size_t channel) const;
  /// With the covariance of all errors.
  const statistics::Uncertainty& uncertainty() const { return *uncertainty_; }
  VectorX residual() const;  ///< D − S

 private:
  std::size_t zeros(const std::vector<std::size_t>& numbers) const;
  statistics::Uncertainty weighed(const std::vector<bool>& aside) const;

  const compare::Comparison* comparison_;
  std::vector<bool> aside_;
  statistics::PartedColumns columns_;
  MatrixX zeros_;  // of sensors, by measured number
  std::vector<double> sigma_;
  std::vector<ComparisonError> errors_;
  VectorX residual_;  // before zeros are taken off
  std::shared_ptr<const statistics::Uncertainty> uncertainty_;
};

}  // namespace deflect::validity
