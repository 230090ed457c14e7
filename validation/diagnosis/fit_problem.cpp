#include "validation/diagnosis/fit_problem.h"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/diagnosis/signatures.h"

namespace deflect::diagnosis {

double coordinate(const effects::EffectParameter& p, double value) {
  return p.log ? std::log(value) : value / (0.5 * (p.high - p.low));
}

double value_at(const effects::EffectParameter& p, double x) {
  const double value = p.log ? std::exp(x) : x * 0.5 * (p.high - p.low);
  return std::clamp(value, p.low, p.high);
}

std::optional<effects::ParameterPrior> prior_of_coordinate(const effects::EffectParameter& p) {
  if (!p.prior) return std::nullopt;
  const double unit = p.log ? p.prior->mean : 0.5 * (p.high - p.low);
  return effects::ParameterPrior{coordinate(p, p.prior->mean), p.prior->deviation / unit};
}

namespace {

constexpr int doublings = 7;
constexpr double nearest_factor = 0.3, farthest_factor = 20;  // logarithms, each twice the one before
constexpr int halvings = 10, refinements = 3;                 // of what lets go, in its size
constexpr double no_more = 1e-3;                              // of χ²: as good as nothing
constexpr double rounding_of_residuals = 1e-10;               // of a thousand readings of 1e4 σ
constexpr double hardly_seen = 1e-7;                          // σ, by the step of a difference, of size 1e-5

/// So many times as far from where it vanishes; a factor on a logarithmic scale runs towards 0 or up by its logarithm.
double times_as_large(const effects::EffectParameter& p, double small, double times) {
  if (std::isinf(*p.vanishes)) return small / times;
  if (p.log && *p.vanishes > 0) return *p.vanishes * std::pow(small / *p.vanishes, times);
  return *p.vanishes + times * (small - *p.vanishes);
}

VectorX all_values(const std::vector<const effects::EffectParameter*>& parameters, const VectorX& x) {
  VectorX out(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) out(i) = value_at(*nth(parameters, i), x(i));
  return out;
}

VectorX all_coordinates(const std::vector<const effects::EffectParameter*>& parameters, const VectorX& values) {
  VectorX out(values.size());
  for (Eigen::Index i = 0; i < out.size(); ++i) out(i) = coordinate(*nth(parameters, i), values(i));
  return out;
}

Eigen::Index priors_of(const std::vector<const effects::EffectParameter*>& all) {
  return std::count_if(all.begin(), all.end(), [](const auto* p) { return p->prior.has_value(); });
}

}  // namespace

FitProblem::FitProblem(const Observations& o, const Hypothesis& h)
    : observations_(o),
      parameters_(parameters_of(h)),
      prepared_(o.subject(), h),
      wall_(VectorX::Constant(o.null_residual().size() + priors_of(parameters_),
                              1e6 * std::max(1.0, o.null_residual().norm()))) {}

VectorX FitProblem::values(const VectorX& x) const { return all_values(parameters_, x); }
VectorX FitProblem::coordinates(const VectorX& values) const { return all_coordinates(parameters_, values); }

VectorX coordinates_of(const Hypothesis& h, const VectorX& values) { return all_coordinates(parameters_of(h), values); }
VectorX values_at(const Hypothesis& h, const VectorX& x) { return all_values(parameters_of(h), x); }

std::optional<VectorX> FitProblem::residual(const VectorX& x, std::string* why) const {
  auto predicted = outcome_of([&] {
    const subject::Subject there = prepared_(values(x));
    return shape_ ? observations_.whitened_residual(there, *shape_) : observations_.whitened_residual(there);
  });
  if (predicted && predicted->allFinite()) {
    VectorX r = std::move(*predicted);
    Eigen::Index row = r.size();
    r.conservativeResize(rows());
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (const auto prior = prior_of_coordinate(*nth(parameters_, i)))
        r(row++) = (x(i) - prior->mean) / prior->deviation;
    return r;
  }
  if (why) *why = predicted ? "the prediction is no number" : predicted.why;
  return std::nullopt;
}

double FitProblem::stand_at(const VectorX& x) {
  auto shape = outcome_of([&] { return observations_.shape_for(prepared_(values(x))); });
  if (!shape) return 0;
  const double change = shape_ ? observations_.uncertainty().whitened(*shape - *shape_).norm() : 0;
  shape_ = std::move(*shape);
  return change;
}

void FitProblem::stand_as_granted() { shape_ = observations_.granted_shape(); }

bool FitProblem::has_history(const VectorX& x) const { return observations_.has_history(prepared_(values(x))); }

VectorX FitProblem::residual_or_wall(const VectorX& x) const { return residual(x).value_or(wall_); }

VectorX FreeResidual::all(const VectorX& x) const {
  VectorX out = held;
  out(free) = x;
  return out;
}

int FreeResidual::operator()(const VectorX& x, VectorX& r) {
  if (last.r.size() == 0 || x != last.x) last = {x, problem->residual_or_wall(all(x))};
  r = last.r;
  return 0;
}

int FreeResidual::df(const VectorX& x, MatrixX& J) {
  const VectorX from = all(x);
  VectorX here;
  operator()(x, here);
  J = MatrixX::Zero(problem->rows(), std::ssize(free));
  for (Eigen::Index i = 0; i < J.cols(); ++i) {
    // Towards the inside where a bound is near, else away from what cannot be predicted.
    const Eigen::Index k = nth(free, i);
    const effects::EffectParameter& p = *nth(problem->parameters(), k);
    double step = 1e-5 * std::max(1.0, std::abs(from(k)));
    if (!(value_at(p, from(k) + step) < p.high)) step = -step;
    for (const double each : {step, -step}) {
      VectorX moved = from;
      moved(k) += each;
      const std::optional<VectorX> there = problem->residual(moved);
      if (!there) continue;
      VectorX change = *there - here;
      // A search takes the parameter of a column that is next to nothing as far as it likes. Rounding is no slope, nor
      // is what changes alike to both sides, as 1 − cos of a turn about an axis that these readings do not show.
      if (change.norm() < hardly_seen) {
        moved(k) = from(k) - each;
        if (const std::optional<VectorX> back = problem->residual(moved)) change = (*there - *back) / 2;
      }
      if (change.norm() > rounding_of_residuals) J.col(i) = change / each;
      break;
    }
  }
  return 0;
}

VectorX minimised(FreeResidual f, VectorX x, int evaluations) {
  Eigen::LevenbergMarquardt<FreeResidual> search(f);
  search.parameters.maxfev = evaluations;
  search.parameters.ftol = 1e-5;  // of χ²: far below what one unit of it means
  search.parameters.xtol = 1e-5;
  search.minimize(x);
  return x;
}

std::optional<SizedEffect> best_size(const Observations& o, const Hypothesis& h, const VectorX& from,
                                     const std::optional<VectorX>& small) {
  const effects::EffectParameter& p = h.back().effect->parameters.front();
  const auto best = outcome_of([&] {
    FitProblem problem(o, h);
    problem.stand_as_granted();
    std::optional<SizedEffect> out;
    /// Whether it explains more than those before.
    const auto take = [&](double value) {
      VectorX values(from.size() + 1);
      values << from, value;
      const std::optional<VectorX> r = problem.residual(problem.coordinates(values));
      if (r && out && out->chi2 <= r->squaredNorm()) return false;
      if (r) out = SizedEffect{VectorX::Constant(1, value), r->squaredNorm()};
      return true;
    };
    if (turns_as_it_grows(*h.back().effect)) {
      for (const double sense : {-1.0, 1.0})
        for (double ln = nearest_factor; ln < farthest_factor; ln *= 2)
          if (const double value = *p.vanishes * std::exp(sense * ln); p.low <= value && value <= p.high) take(value);
      return out;
    }
    double last = NAN;
    for (int k = 0; small && k <= doublings; ++k) {
      const double value = std::clamp(times_as_large(p, (*small)(0), std::exp2(k)), p.low, p.high);
      if (value == last || !take(value)) break;  // at the bound
      last = value;
    }
    return out;
  });
  return best ? *best.value : std::nullopt;  // the effects may not go together in this subject
}

std::optional<SizedEffect> best_size_of_what_lets_go(const Observations& o, const Hypothesis& h, const VectorX& from,
                                                     double most) {
  const effects::EffectParameter& p = h.back().effect->parameters.front();
  const bool upwards = *p.vanishes == 0;  // it lets go towards its upper bound
  const double gone = upwards ? p.high : p.low, least = upwards ? p.low : std::min(p.high, *p.vanishes);
  const auto best = outcome_of([&]() -> std::optional<SizedEffect> {
    FitProblem problem(o, h);
    problem.stand_as_granted();
    /// The effect so many times nearer to where it vanishes than at that value.
    const auto nearer = [&](double value, double times) {
      const double size = upwards ? value / times : value * times;
      SizedEffect out{VectorX::Constant(1, size), INFINITY};
      if (upwards ? size < least || size > gone : size > least || size < gone) return out;
      VectorX values(from.size() + 1);
      values << from, size;
      if (const auto r = problem.residual(problem.coordinates(values))) out.chi2 = r->squaredNorm();
      return out;
    };
    SizedEffect out = nearer(gone, 1);
    if (!(out.chi2 < most)) return std::nullopt;
    for (SizedEffect next = nearer(gone, 10); std::abs(next.chi2 - out.chi2) < no_more; next = nearer(out.value(0), 10))
      out = next;
    const double begins = out.value(0);
    for (int k = 1; k <= halvings; ++k)
      if (SizedEffect next = nearer(begins, std::exp2(k)); next.chi2 < out.chi2 + no_more) out = std::move(next);
    double times = 2;
    for (int k = 0; k < refinements; ++k) {
      times = std::sqrt(times);
      if (SizedEffect next = nearer(out.value(0), times); next.chi2 < out.chi2 + no_more)
        out = std::move(next);
      else if (next = nearer(out.value(0), 1 / times); next.chi2 < out.chi2 - no_more)
        out = std::move(next);
    }
    return out;
  });
  return best ? *best.value : std::nullopt;
}

}  // namespace deflect::diagnosis
