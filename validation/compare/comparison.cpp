#include "validation/compare/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "msa/base/error.h"
#include "validation/compare/columns.h"
#include "validation/compare/errors_by_group.h"
#include "validation/compare/findings.h"
#include "validation/compare/held_out.h"
#include "validation/compare/outliers.h"
#include "validation/compare/residual_study.h"
#include "validation/compare/tail.h"

namespace deflect {
namespace {

/// σ of every measured number: the file's or replicates', else the option's.
std::optional<std::vector<double>> sigma_of(const std::vector<MeasuredValue>& values, const ComparisonOptions& o) {
  std::vector<double> out;
  for (const MeasuredValue& v : values) {
    const std::optional<double> sigma = v.sigma ? v.sigma : v.component < 3 ? o.sigma_u : o.sigma_th;
    if (!sigma) return std::nullopt;
    out.push_back(*sigma);
  }
  return out;
}

constexpr int fewest_left = 10;  // freedoms, for a scatter to within a quarter of itself

/// The scatter that no pattern explains, alike for all translations and for all rotations.
std::vector<double> scatter(const ResidualStudy& s, const VectorX& r, const MatrixX& patterns) {
  const std::vector<double> one(s.values.size(), 1e-6);
  const Uncertainty u(PartedColumns(MatrixX(r.size(), 0)), s.values, one, s.predicted, 0);
  const Regression fit = regress(u, r, patterns);
  if (static_cast<int>(s.values.size()) < fit.freedoms + fewest_left)
    throw InputError(
        fmt::format("{}: neither σ nor replicates, and {} measured numbers are too few to read the scatter off what no "
                    "pattern explains: add a column sigma_u_mm (sigma_th_rad), repeat readings, or give --sigma "
                    "(--sigma-rotation)",
                    s.data->origin, s.values.size()));
  const VectorX left = r - patterns * fit.amplitude;
  double squares[2] = {0, 0}, n[2] = {0, 0};
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    const std::size_t kind = s.values[i].component < 3 ? 0 : 1;
    squares[kind] += left(static_cast<Eigen::Index>(i)) * left(static_cast<Eigen::Index>(i));
    n[kind] += 1;
  }
  const auto count = static_cast<double>(s.values.size());
  std::vector<double> out;
  for (const MeasuredValue& v : s.values) {
    const std::size_t kind = v.component < 3 ? 0 : 1;
    out.push_back(std::max(1e-12, std::sqrt(squares[kind] / n[kind] * count / std::max(1.0, count - fit.freedoms))));
  }
  return out;
}

/// Root mean square of a residual that Errors speak of, with nothing missing.
double expected_rmse(const ResidualStudy& s, const PartedColumns& A, const std::vector<double>& sigma) {
  double squares = 0, n = 0;
  const bool rotations = rotations_alone(s.values);
  const VectorX tolerances = A.squared_row_norms();
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    const MeasuredValue& v = s.values[i];
    if ((v.component >= 3) != rotations) continue;
    const double load = s.mechanism->tolerances.load * s.predicted[v.reading](static_cast<Eigen::Index>(v.component));
    squares += sigma[i] * sigma[i] + load * load + tolerances(static_cast<Eigen::Index>(i));
    n += 1;
  }
  return n > 0 ? std::sqrt(squares / n) : 0;
}

}  // namespace

bool rotations_alone(const std::vector<MeasuredValue>& values) {
  return std::all_of(values.begin(), values.end(), [](const MeasuredValue& v) { return v.component >= 3; });
}

double rms_of_kept(const std::vector<MeasuredValue>& values, const VectorX& x, const std::vector<bool>& set_aside) {
  std::vector<MeasuredValue> kept;
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!set_aside[values[i].reading]) kept.push_back(values[i]), rows.push_back(static_cast<Eigen::Index>(i));
  return rms_of_errors(kept, x(rows));
}

double rms_of_errors(const std::vector<MeasuredValue>& values, const VectorX& x) {
  const bool rotations = rotations_alone(values);
  double squares = 0, n = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if ((values[i].component >= 3) == rotations) {
      squares += x(static_cast<Eigen::Index>(i)) * x(static_cast<Eigen::Index>(i));
      n += 1;
    }
  return n > 0 ? std::sqrt(squares / n) : 0;
}

namespace {

/// `account`: what account_of() asks for, without tests, curves and held-out poses.
enum class Extent { account, whole };

/// Everything but the mistakes of recording.
Comparison compared_as_recorded(const Mechanism& m, const Measurements& data, const ComparisonOptions& o,
                                Extent extent = Extent::whole) {
  if (data.readings.size() < 2)
    throw InputError(fmt::format("{}: one reading says nothing of a model: two or more are wanted", data.origin));
  Comparison c;
  c.device = m.name;
  c.data = data.origin;
  c.readings = data.readings.size();
  c.poses = data.poses.size();
  c.study = residual_study(m, data, o.threads, part_of(o.progress, 0, 0.5));
  const ResidualStudy& s = c.study;
  c.numbers = s.values.size();
  c.pure_error = rotations_alone(s.values) ? pure_error(data).th : pure_error(data).u;
  VectorX measured(static_cast<Eigen::Index>(s.values.size()));
  for (std::size_t i = 0; i < s.values.size(); ++i) measured(static_cast<Eigen::Index>(i)) = s.values[i].value;
  c.residual = measured - rows_of(s.values, s.predicted);
  add_errors(c);

  c.tolerances = tolerance_model(m, s.machines, data, s.values, o.threads, part_of(o.progress, 0.5, 0.95));
  const std::vector<Pattern> patterns = patterns_of(s);
  std::vector<MatrixX> columns;
  for (const Pattern& p : patterns) columns.push_back(rows_of(s.values, p.by_reading));
  const MatrixX all = side_by_side(columns, c.residual.size());

  // A linear model leaves the deformed shape out, which is known in size: what follows looks for other things.
  VectorX r = c.residual, shape;
  if (!s.deformed_shape.empty()) {
    shape = rows_of(s.values, s.deformed_shape);
    c.deformed_shape = rms_of_errors(s.values, shape);
    r -= shape;
  }
  if (const auto sigma = sigma_of(s.values, o))
    c.sigma = *sigma;
  else
    c.sigma = scatter(s, r, all), c.sigma_from_residuals = true;
  const std::vector<bool> aside = gross_outliers(s, c.tolerances.A, c.sigma, r, all);
  for (std::size_t i = 0; i < aside.size(); ++i)
    if (aside[i]) c.set_aside.push_back(data.readings[i].line);
  const Uncertainty u(c.tolerances.A, s.values, c.sigma, s.predicted, m.tolerances.load, aside);

  c.kept_rmse = rms_of_kept(s.values, c.residual, aside);
  const double chi2 = u.inner(c.residual, c.residual)(0, 0);
  const auto freedoms = static_cast<double>(u.count());
  c.chi2_per_dof = chi2 / freedoms;
  c.p_value = chi_squared_tail(freedoms, chi2);
  c.sigma_u =
      rms_of_errors(s.values, Eigen::Map<const VectorX>(c.sigma.data(), static_cast<Eigen::Index>(c.sigma.size())));
  c.noise_and_tolerances = expected_rmse(s, c.tolerances.A, c.sigma);
  const Findings found = find_patterns(s, u, r, patterns, columns);
  c.findings = found.findings;
  c.unexplained_chi2_per_dof = found.chi2_left / std::max(1.0, freedoms - static_cast<double>(found.columns.cols()));
  if (extent == Extent::account) return c;
  c.held_out = HeldOut(s, u, aside).rmse(c.residual);
  c.contrasts = contrast_tests(s, u, r, aside);
  const Regressions regressions(u, r);
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    PatternTest t{patterns[i].id, patterns[i].title, regressions.on(columns[i]), 0};
    t.size = rms_of_errors(s.values, columns[i] * t.alone.amplitude);
    c.patterns.push_back(std::move(t));
  }
  if (shape.size() > 0) c.deformed_shape_fit = regress(u, c.residual, shape, found.columns);
  c.curves = elongation_curves(s, u, r);
  const VectorX eta = u.nuisances(r);
  for (Eigen::Index i = 0; i < eta.size(); ++i)
    if (std::abs(eta(i)) > 2) c.strained.emplace_back(c.tolerances.nuisances[static_cast<std::size_t>(i)].name, eta(i));
  return c;
}

}  // namespace

bool is_mistaken(const Comparison& c) { return !c.mistakes.empty() && c.mistakes.front().certain; }

Comparison compare(const Mechanism& m, const Measurements& data, const ComparisonOptions& o) {
  Comparison c;
  try {
    c = compared_as_recorded(m, data, o);
  } catch (const ModelError& e) {
    throw ModelError(e.what() + within_reach_hint(m, data));
  }
  if (o.as_recorded) return c;
  ComparisonOptions quiet = o;
  quiet.progress = {};
  c.mistakes = recording_mistakes(m, c, o.threads, [&](const Measurements& other) {
    return account_of(compared_as_recorded(m, other, quiet, Extent::account));
  });
  return c;
}

}  // namespace deflect
