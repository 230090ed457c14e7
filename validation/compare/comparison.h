// Where a model fails: measurements against prediction, without fitting the model to them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "validation/compare/contrasts.h"
#include "validation/compare/elongation.h"
#include "validation/compare/patterns.h"
#include "validation/compare/plausibility.h"
#include "validation/prediction/prediction.h"
#include "validation/statistics/uncertainty.h"

namespace deflect {

/// Whether no translation was measured: the errors are then those of rotations, in rad where m is said below.
bool rotations_alone(const std::vector<MeasuredValue>&);

/// Root mean square over the numbers that errors speak of: m, or rad of rotations alone; 0 without any.
double rms_of_errors(const std::vector<MeasuredValue>&, const VectorX&);

/// The same over the readings that are not set aside.
double rms_of_kept(const std::vector<MeasuredValue>&, const VectorX&, const std::vector<bool>& set_aside);

/// Of residuals measured − predicted: translations in m, or rotations in rad where none were measured.
struct Errors {
  std::string group;  ///< "pose 3", "fx > 0", "30 … 50 N"; empty for all
  std::size_t readings = 0;
  double rmse = 0;  ///< root mean square of |r| by component
  Vector3 bias = Vector3::Zero();
  double worst = 0;            ///< largest |component|
  std::size_t worst_line = 0;  ///< of the file
  double measured = 0;         ///< root mean square of the measured components
};

/// A pattern that the residual holds, in the order found: each given those before it.
struct Finding {
  std::string pattern;   ///< id (patterns.h), or "elastic at SITE"
  std::string sentence;  ///< what, where, how large, with numbers
  std::vector<std::string> columns;
  VectorX amplitude, deviation;  ///< with standard deviations; in `unit`
  std::string unit;
  double size = 0;   ///< m: root mean square of what it adds to readings
  double share = 0;  ///< of the misfit beyond noise and tolerances (χ²) that it explains
  double gain = 0;   ///< χ² taken away
  int freedoms = 0;
  double p_value = 1;
  MatrixX shape;                     ///< columns over the measured numbers
  std::vector<std::string> instead;  ///< other patterns that would do nearly as well
};

/// The residual regressed on one pattern alone.
struct PatternTest {
  std::string pattern, title;
  Regression alone;
  double size = 0;  ///< m
};

struct Comparison {
  std::string device, data;
  std::size_t readings = 0, poses = 0, numbers = 0;
  bool sigma_from_residuals = false;  ///< neither σ nor replicates: scatter is what no pattern explains
  double sigma_u = 0;                 ///< m: root mean square of the readings' σ
  std::optional<NoiseEstimate> pure_error;
  Errors all;
  std::vector<Errors> by_axis, by_pose, by_direction, by_magnitude, by_heading;
  double kept_rmse = 0;             ///< of the readings that are not set aside, m or rad
  double chi2_per_dof = 0;          ///< against noise and tolerances
  double p_value = 1;               ///< of such a χ² by chance
  double noise_and_tolerances = 0;  ///< m: root mean square expected of a residual with nothing missing
  double held_out = 0;              ///< m: rmse at each pose with the tolerances learnt at the others
  double deformed_shape = 0;        ///< m: root mean square of what a linear model leaves out of the equilibrium
  std::optional<Regression> deformed_shape_fit;  ///< its amplitude in the data, 1 expected
  std::vector<ContrastTest> contrasts;
  std::vector<PatternTest> patterns;
  std::vector<Finding> findings;  ///< empty: nothing is missing that these readings can show
  double unexplained_chi2_per_dof = 0;
  std::vector<std::size_t> set_aside;                    ///< lines of gross outliers
  std::vector<std::pair<std::string, double>> strained;  ///< tolerances beyond two standard deviations, with them
  std::vector<RecordingMistake> mistakes;                ///< plausibility.h: of recording, the headline first
  std::vector<ElongationCurve> curves;                   ///< of the sites
  ToleranceModel tolerances;
  ResidualStudy study;        ///< residuals, forces, sites: for figures
  VectorX residual;           ///< of study.values
  std::vector<double> sigma;  ///< of study.values
};

struct ComparisonOptions {
  std::optional<double> sigma_u, sigma_th;  ///< m, rad: where the file has none
  bool as_recorded = false;                 ///< no mistakes of recording are looked for
  int threads = 0;
  Told progress = {};
};

/// Whether the first thing to be said of the data is a mistake of recording: no verdict on the machine has a ground.
bool is_mistaken(const Comparison&);

/// Throws InputError where the data are too few, ModelError, NumericalError as predict() does.
Comparison compare(const Mechanism&, const Measurements&, const ComparisonOptions& = {});

}  // namespace deflect
