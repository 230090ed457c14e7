// Where a model fails: measurements against prediction, without fitting the model to them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "validation/compare/contrasts.h"
#include "validation/compare/elongation.h"
#include "validation/compare/errors_by_group.h"
#include "validation/compare/findings.h"
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

struct Comparison {
  std::string device, data;
  std::size_t readings = 0, poses = 0, numbers = 0;
  bool sigma_from_residuals = false;  ///< neither σ nor replicates: scatter is what no pattern explains
  double sigma_u = 0;                 ///< m: root mean square of the readings' σ
  std::optional<measurement::NoiseEstimate> pure_error;
  Errors all;
  std::vector<Errors> by_axis, by_pose, by_direction, by_magnitude, by_heading;
  double kept_rmse = 0;             ///< of the readings that are not set aside, m or rad
  double chi2_per_dof = 0;          ///< against noise and tolerances
  double p_value = 1;               ///< of such a χ² by chance
  double noise_and_tolerances = 0;  ///< m: root mean square expected of a residual with nothing missing
  double held_out = 0;              ///< m: rmse at each pose with the tolerances learnt at the others
  double deformed_shape = 0;        ///< m: root mean square of what a linear model leaves out of the equilibrium
  std::optional<statistics::Regression> deformed_shape_fit;  ///< its amplitude in the data, 1 expected
  std::vector<ContrastTest> contrasts;
  std::vector<PatternTest> patterns;
  std::vector<Finding> findings;  ///< empty: nothing is missing that these readings can show
  double unexplained_chi2_per_dof = 0;
  std::vector<std::size_t> set_aside;                    ///< lines of gross outliers
  std::vector<std::pair<std::string, double>> strained;  ///< tolerances beyond two standard deviations, with them
  std::vector<RecordingMistake> mistakes;                ///< plausibility.h: of recording, the headline first
  std::vector<ElongationCurve> curves;                   ///< of the sites
  statistics::ToleranceModel tolerances;
  ResidualStudy study;        ///< residuals, forces, sites: for figures
  VectorX residual;           ///< of study.values
  std::vector<double> sigma;  ///< of study.values
};

struct ComparisonOptions {
  std::optional<double> sigma_u, sigma_th;  ///< m, rad: where the file has none
  bool as_recorded = false;                 ///< no mistakes of recording are looked for
};

/// Whether the first thing to be said of the data is a mistake of recording: no verdict on the machine has a ground.
bool is_mistaken(const Comparison&);

/// Throws InputError where the data are too few, ModelError, NumericalError as predict() does.
Comparison compare(const subject::Subject&, const measurement::Measurements&, const ComparisonOptions& = {},
                   const parallel::Work& = {});

}  // namespace deflect::compare
