// Where a model fails: compares measurements with predictions, without fitting the model.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "validation/compare/contrasts.h"
#include "validation/compare/elongation.h"
#include "validation/compare/errors_by_group.h"
#include "validation/compare/findings.h"
#include "validation/compare/inner_sites.h"
#include "validation/compare/plausibility.h"
#include "validation/prediction/prediction.h"
#include "validation/statistics/uncertainty.h"

namespace deflect::compare {

/// The residual regressed on one pattern alone.
struct PatternTest {
  std::string pattern, title;
  statistics::Regression alone;
  double size = 0;  ///< m
};

/// Standard deviation of what equilibrium in the deformed shape contributes, as a share of it: a missing effect changes
/// it.
inline constexpr double shape_known_to = 0.2;

struct Comparison {
  std::string device, data;
  std::size_t readings = 0, poses = 0, numbers = 0;
  bool sigma_from_residuals = false;  ///< of the numbers that Errors speak of: neither σ nor replicates are given, and
                                      ///< noise is estimated from what no pattern explains
  double sigma_u = 0;                 ///< m: root mean square of σ over the readings
  std::optional<measurement::NoiseEstimate> pure_error;
  Errors all;
  std::vector<Errors> by_axis, by_pose, by_direction, by_magnitude, by_heading;
  double kept_rmse = 0;     ///< of the readings not set aside, beside equilibrium in the deformed shape, m or rad
  double chi2_per_dof = 0;  ///< given noise and tolerances
  double p_value = 1;       ///< probability of so large a χ² by chance
  double noise_and_tolerances = 0;  ///< m: root mean square expected where nothing is missing
  double held_out = 0;              ///< m: rmse in cross-validation (held_out.h)
  double deformed_shape = 0;        ///< m: root mean square of ResidualStudy::deformed_shape
  double chi2_beside_shape = 0;     ///< chi2_per_dof of what the deformed shape leaves, known to shape_known_to
  std::optional<statistics::Regression> deformed_shape_fit;  ///< its amplitude fitted to the data, 1 expected
  std::vector<ContrastTest> contrasts;
  std::vector<PatternTest> patterns;
  std::vector<Finding> findings;  ///< empty: these readings show nothing missing
  double unexplained_chi2_per_dof = 0;
  std::vector<std::size_t> set_aside;  ///< file lines of gross outliers
  /// Tolerances that deviate by more than two standard deviations, each with its number of standard deviations.
  std::vector<std::pair<std::string, double>> strained;
  std::vector<RecordingMistake> mistakes;  ///< recording mistakes (plausibility.h), the headline first
  std::vector<ElongationCurve> curves;     ///< of the sites, all together; of a frame's, each alone
  std::vector<InnerSiteFit> inner;         ///< of a frame, the most telling first
  std::size_t telling = 0;                 ///< the reading whose residual is the least likely by chance
  VectorX residual_forces;                 ///< of a frame by study.inner, at that reading
  statistics::ToleranceModel tolerances;
  ResidualStudy study;          ///< residuals, forces, sites: for figures
  VectorX residual;             ///< of study.values
  std::vector<double> sigma;    ///< of study.values
  std::vector<bool> estimated;  ///< of study.values: nobody tells σ, it is from what no pattern explains
};

struct ComparisonOptions {
  std::optional<double> sigma_u, sigma_th;  ///< m, rad: used where the file has none
  bool as_recorded = false;                 ///< recording mistakes are not searched for
  /// Of the measured numbers: used where nobody tells σ. Empty: it is estimated.
  std::vector<double> sigma = {};
};

/// By measured number: the standard deviation that noise and tolerances give its residual with nothing missing. Unknown
/// zeros do not count, because the residual is free of them.
VectorX expected_deviations(const Comparison&);

/// Whether nobody tells the σ of some number.
bool is_any_estimated(const Comparison&);

/// Whether a certain recording mistake was found: the data then support no verdict on the machine.
bool is_mistaken(const Comparison&);

/// Throws InputError where there are too few data; ModelError and NumericalError as predict() does.
Comparison compare(const subject::Subject&, const measurement::Measurements&, const ComparisonOptions& = {},
                   const parallel::Work& = {});

}  // namespace deflect::compare
