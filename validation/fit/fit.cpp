#include "validation/fit/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "validation/statistics/tail.h"

namespace deflect::fit {
namespace {

/// A search ends after forty predictions; it goes on from there while it still falls.
diagnosis::Fit searched(const diagnosis::Observations& o, const diagnosis::Hypothesis& h, VectorX values) {
  constexpr int most_searches = 8;
  diagnosis::Fit out = diagnosis::fit_of_all(o, h, values);
  for (int i = 1; out.found && i < most_searches; ++i) {
    const double before = out.chi2;
    diagnosis::Fit again = diagnosis::fit_of_all(o, h, out.values);
    if (again.found && again.chi2 < out.chi2) out = std::move(again);
    if (!(before - out.chi2 > 1e-3)) break;
  }
  if (!out.found) throw NumericalError("no values can be fitted: " + out.why);
  return out;
}

VectorX values_of(const std::vector<FreeParameter>& all) {
  VectorX out(std::ssize(all));
  for (std::size_t i = 0; i < all.size(); ++i) out(as_index(i)) = all[i].value;
  return out;
}

/// One round of the fit: what is observed, without the tolerances that the parameters replace; values in SI.
struct Round {
  diagnosis::Observations observations;
  VectorX values;
  double declared_chi2 = 0;  // of the subject as given, with all tolerances as declared
};

Round fitted_round(const diagnosis::Observations& observed, const std::vector<std::size_t>& exact,
                   const std::vector<FreeParameter>& all) {
  Round out{observed.exact_in(exact), {}, observed.null_residual().squaredNorm()};
  const Freed freed(all);
  out.values = freed.values(searched(out.observations, freed.hypothesis(), freed.effect_values(values_of(all))).values);
  return out;
}

Round first_round(const subject::Subject& s, const measurement::Measurements& data,
                  const std::vector<FreeParameter>& all, const compare::ComparisonOptions& options,
                  const parallel::Work& work) {
  const diagnosis::Observations observed(s, data, options, work);
  return fitted_round(observed, replaced_tolerances(s, all, observed.comparison().tolerances.nuisances), all);
}

/// Weighed and judged by the subject with the values found so far; the search is about its numbers, without effects.
Round next_round(const Round& before, const subject::Subject& numbers, const measurement::Measurements& data,
                 const std::vector<FreeParameter>& all, const compare::ComparisonOptions& options,
                 const parallel::Work& work) {
  const bool effects = has_effects(all);
  const subject::Subject judge = effects ? with_values(numbers, all, values_of(all)) : numbers;
  const diagnosis::Observations observed(judge, data, options, work);
  const std::vector<subject::Tolerance>& tolerances = observed.comparison().tolerances.nuisances;
  std::vector<std::size_t> exact = replaced_tolerances(numbers, all, tolerances);
  if (!effects) return fitted_round(observed, exact, all);
  for (const std::size_t i : added_tolerances(before.observations.comparison().tolerances.nuisances, tolerances))
    exact.push_back(i);
  return fitted_round(observed.about(numbers), exact, all);
}

void require_no_mistake(const compare::Comparison& c, const std::string& origin) {
  if (!compare::is_mistaken(c)) return;
  throw InputError(fmt::format("{}: {}. Correct the file, or fit it as it is with --as-recorded", origin,
                               c.mistakes.front().sentence));
}

/// Root mean square over the numbers of the quantity of errors that are not set aside.
double rms_of(const diagnosis::Observations& o, const VectorX& numbers) {
  return compare::rms_of_kept(o.comparison().study.values, numbers, o.aside());
}

std::vector<std::pair<measurement::Quantity, double>> sigmas_of(const compare::Comparison& c) {
  std::map<measurement::Quantity, std::pair<double, double>> sums;
  for (std::size_t i = 0; i < c.sigma.size(); ++i) {
    auto& [squares, n] = sums[c.study.values[i].quantity];
    squares += c.sigma[i] * c.sigma[i];
    n += 1;
  }
  std::vector<std::pair<measurement::Quantity, double>> out;
  for (const auto& [quantity, sum] : sums) out.emplace_back(quantity, std::sqrt(sum.first / sum.second));
  return out;
}

void add_parameters(FitResult& out, const subject::Subject& s, const std::vector<FreeParameter>& all,
                    const VectorX& values) {
  const VectorX first = first_numbers(s, all);
  const auto k = std::ssize(all);
  out.correlation = MatrixX::Identity(k, k);
  for (Eigen::Index i = 0; i < k; ++i) {
    FittedParameter p{nth(all, i)};
    p.first = first(i);
    p.fitted = values(i);
    p.deviation = std::sqrt(out.posterior.covariance(i, i));
    const double x = p.coordinate(p.fitted);
    p.low = std::max(p.least, p.value_at(x - normal95 * p.deviation));
    p.high = std::min(p.most, p.value_at(x + normal95 * p.deviation));
    if (p.prior)
      p.pull =
          (x - p.coordinate(p.prior->mean)) / (p.positive ? p.prior->deviation / p.prior->mean : p.prior->deviation);
    else if (const auto sigma = declared_deviation(s, p))
      p.beyond_tolerance = (x - p.coordinate(p.value)) / *sigma;
    out.parameters.push_back(std::move(p));
    for (Eigen::Index j = 0; j < k; ++j)
      out.correlation(i, j) =
          out.posterior.covariance(i, j) / std::sqrt(out.posterior.covariance(i, i) * out.posterior.covariance(j, j));
  }
}

/// How far the parameters' coordinates are from the posterior's mean, those held that stand at a bound and would leave
/// it: the mean of the others is then that given these, δ − C(:,i)/C(i,i) δ_i.
VectorX step_left(const Posterior& posterior, const std::vector<FreeParameter>& all, const VectorX& values) {
  constexpr double near = 1e-6;  // of the range: a search comes so close
  const auto k = std::ssize(all);
  VectorX step = posterior.mean.head(k);
  MatrixX C = posterior.covariance.topLeftCorner(k, k);
  for (bool leaves = true; leaves;) {
    leaves = false;
    for (Eigen::Index i = 0; i < k && !leaves; ++i) {
      const FreeParameter& p = nth(all, i);
      const double x = p.coordinate(values(i)), reach = near * search_range(p);
      leaves = (step(i) > 0 && p.coordinate(p.most) - x < reach) || (step(i) < 0 && x - p.coordinate(p.least) < reach);
      if (!leaves) continue;
      step -= VectorX(C.col(i) / C(i, i)) * step(i);
      step(i) = 0;
      C -= MatrixX(C.col(i) * C.row(i) / C(i, i));
    }
  }
  return step;
}

void add_quality(FitResult& out, const Round& before, const Round& after, const subject::Subject& s,
                 const Learnt& learnt) {
  const diagnosis::Observations &first = before.observations, &last = after.observations;
  const auto n = static_cast<double>(last.numbers());
  const auto freedoms = std::max(1.0, n - static_cast<double>(out.parameters.size()));
  out.chi2_before = before.declared_chi2;
  out.chi2_after = last.whitened_residual(s).squaredNorm();
  out.before = {first.rmse(first.subject()), first.held_out_rmse(first.subject()),
                out.chi2_before / static_cast<double>(first.numbers())};
  out.after = {last.rmse(s), 0, out.chi2_after / freedoms};
  out.p_value = statistics::chi_squared_tail(freedoms, out.chi2_after);
  const HeldOutNumbers held = learnt.held_out();
  out.after.held_out = rms_of(last, held.residual);
  out.discrepancies = discrepancies(last, held);
  if (out.p_value >= significant_misfit)
    for (Discrepancy& each : out.discrepancies) each.share = 0;
}

}  // namespace

VectorX fitted_values(const FitResult& r) {
  VectorX out(std::ssize(r.parameters));
  for (std::size_t i = 0; i < r.parameters.size(); ++i) out(as_index(i)) = r.parameters[i].fitted;
  return out;
}

FitResult fit(const subject::Subject& s, const measurement::Measurements& data, const std::vector<FreeParameter>& all,
              const compare::ComparisonOptions& options, const parallel::Work& work) {
  const Round first = first_round(s, data, all, options, work.part(0, 0.5));
  const compare::Comparison& c = first.observations.comparison();
  require_no_mistake(c, data.origin);
  compare::ComparisonOptions as_recorded = options;
  as_recorded.as_recorded = true;
  const subject::Subject numbers = with_numbers(s, all, first.values);
  std::vector<FreeParameter> moved = in_version(all, first.values);
  for (FreeParameter& p : moved) p = bounded(std::move(p), numbers);
  const Round last = next_round(first, numbers, data, moved, as_recorded, work.part(0.5, 1));
  const Learnt learnt(last.observations, moved, last.values);
  const subject::Subject final = with_values(numbers, moved, last.values);
  // Where the search ended at its own range, the description may allow more. What was found says what is little of it.
  std::vector<FreeParameter> here = in_version(moved, last.values), scaled = moved;
  MatrixX per_scale = learnt.whitened_derivative();
  for (std::size_t i = 0; i < here.size(); ++i) {
    here[i] = bounded(std::move(here[i]), final);
    if (here[i].scale() <= moved[i].scale()) continue;
    scaled[i] = here[i];
    per_scale.col(as_index(i)) *= here[i].scale() / moved[i].scale();
  }

  FitResult out;
  out.device = s.name();
  out.data = data.origin;
  out.how_read = data.how_read;
  out.readings = data.readings.size();
  out.poses = data.poses.size();
  out.numbers = last.observations.numbers();
  out.set_aside = last.observations.set_aside();
  out.posterior = learnt.posterior();
  const std::vector<subject::Tolerance>& tolerances = last.observations.comparison().tolerances.nuisances;
  add_parameters(out, s, in_version(here, values_of(all)), last.values);
  const VectorX shift = step_left(out.posterior, here, last.values);
  for (Eigen::Index i = 0; i < shift.size(); ++i)
    out.converged = out.converged && std::abs(shift(i)) < 0.1 * nth(out.parameters, i).deviation;
  out.undetermined = undetermined(per_scale, scaled, last.values);
  add_quality(out, first, last, final, learnt);
  const compare::Comparison& after = last.observations.comparison();
  out.quantity = compare::quantity_of_errors(after.study.values);
  out.noise_and_tolerances = after.noise_and_tolerances;
  out.tolerance_scale = last.observations.tolerance_scale();
  for (const compare::Finding& f : after.findings) out.findings.push_back(f.sentence);
  out.strained = last.observations.strained(final);
  for (const subject::Tolerance& t : tolerances)
    if (!t.pose) out.tolerances.push_back(t.name);
  out.tolerances.emplace_back("deformed shape");
  out.sigma = sigmas_of(after);
  return out;
}

}  // namespace deflect::fit
