#include "validation/validity/validation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "validation/statistics/tail.h"

namespace deflect::validity {
namespace {

using measurement::Measurements;
using subject::Subject;

Measurements without_readings(Measurements m) {
  for (measurement::Reading& r : m.readings) r.displacement = {}, r.sensors.clear();
  return m;
}

double rms(const std::vector<double>& x) {
  double squares = 0;
  for (const double each : x) squares += each * each;
  return x.empty() ? 0 : std::sqrt(squares / static_cast<double>(x.size()));
}

double rms_of(const std::vector<const ComparisonError*>& all, double (*of)(const ComparisonError&)) {
  std::vector<double> x;
  for (const ComparisonError* e : all) x.push_back(of(*e));
  return rms(x);
}

double u_of(const ComparisonError& e) { return statistics::normal_distribution(-e.E() / e.u_val()); }

ChannelValidity channel_validity(const Errors& errors, std::size_t channel) {
  const compare::ResidualStudy& s = errors.comparison().study;
  ChannelValidity out;
  out.name = measurement::channel_name(*s.data, channel);
  std::vector<const ComparisonError*> all;
  std::vector<double> z;
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    if (s.values[i].channel != channel || !errors.counts(i)) continue;
    const ComparisonError& e = errors.all()[i];
    out.quantity = s.values[i].quantity;
    all.push_back(&e);
    z.push_back(-e.E() / e.u_val());
    out.u.push_back(u_of(e));
    out.mean_E += e.E();
    out.within += std::abs(e.E()) <= coverage_factor * e.u_val();
    pairs.push_back({e.S, e.D, std::hypot(e.input, e.u_D())});
  }
  const auto n = static_cast<double>(std::max<std::size_t>(1, all.size()));
  out.numbers = all.size();
  out.mean_E /= n;
  out.within /= n;
  out.rms_E = rms_of(all, [](const ComparisonError& e) { return e.E(); });
  out.rms_D = rms_of(all, [](const ComparisonError& e) { return e.D; });
  out.num = rms_of(all, [](const ComparisonError& e) { return e.num; });
  out.input = rms_of(all, [](const ComparisonError& e) { return e.input; });
  out.noise = rms_of(all, [](const ComparisonError& e) { return e.noise; });
  out.load = rms_of(all, [](const ComparisonError& e) { return e.load; });
  out.val = rms_of(all, [](const ComparisonError& e) { return e.u_val(); });
  out.agreement = errors.agreement_of_channel(channel);
  std::sort(out.u.begin(), out.u.end());
  out.area = area_from_uniform(out.u);
  out.area_SI = area_from_normal(z) * out.val;
  out.bias = bias_of(pairs);
  return out;
}

/// What is beyond u_val, as a share of the reading's prediction; 0 where all agrees.
std::vector<fit::Discrepancy> discrepancies_of(const Errors& errors, const Agreement& agreement) {
  const compare::ResidualStudy& s = errors.comparison().study;
  const VectorX predicted = statistics::rows_of(s.values, s.predicted);
  std::set<measurement::Quantity> quantities;
  for (const measurement::MeasuredValue& v : s.values) quantities.insert(v.quantity);
  std::vector<fit::Discrepancy> out;
  for (const measurement::Quantity quantity : quantities) {
    double excess = 0, squares = 0;
    for (std::size_t i = 0; i < s.values.size(); ++i) {
      if (s.values[i].quantity != quantity || !errors.counts(i)) continue;
      const ComparisonError& e = errors.all()[i];
      excess += e.E() * e.E() - e.u_val() * e.u_val();
      const double size = fit::size_of_prediction(s.values, predicted, s.values[i].reading, quantity);
      squares += size * size;
    }
    const bool any = !agrees(agreement) && excess > 0 && squares > 0;
    out.push_back({quantity, any ? std::sqrt(excess / squares) : 0});
  }
  return out;
}

bool same_reading(const Measurements& a, const measurement::Reading& r, const Measurements& b,
                  const measurement::Reading& q) {
  const measurement::PoseGroup &p = a.poses[r.pose], &o = b.poses[q.pose];
  return r.displacement == q.displacement && r.sensors == q.sensors && r.load == q.load && r.factors == q.factors &&
         r.at_points == q.at_points && p.pose_mm_deg == o.pose_mm_deg && p.joints.size() == o.joints.size() &&
         (p.joints.size() == 0 || p.joints == o.joints);
}

/// At no load many readings are zero, and equal without being the same.
bool is_loaded(const measurement::Reading& r) {
  const auto any = [](double x) { return x != 0; };
  return !r.load.isZero(0) || std::any_of(r.factors.begin(), r.factors.end(), any) ||
         std::any_of(r.at_points.begin(), r.at_points.end(), [](const Vector6& F) { return !F.isZero(0); });
}

/// What a model was fitted to cannot validate it.
void require_apart(const Measurements& calibration, const Measurements& validation) {
  for (const measurement::Reading& r : calibration.readings)
    for (const measurement::Reading& q : validation.readings)
      if (is_loaded(r) && same_reading(calibration, r, validation, q))
        throw InputError(
            fmt::format("{}:{}: the same reading stands in {}:{}: data that a model was calibrated with "
                        "cannot validate it; give readings of their own for validation",
                        calibration.origin, r.line, validation.origin, q.line));
}

double difference_of_theories(const fit::PredictedPlan& plan) {
  std::map<measurement::Quantity, std::pair<double, double>> squares;  // differences, predictions
  for (const fit::PredictedNumber& n : plan.numbers) {
    const auto [least, most] = std::minmax_element(n.by_theory.begin(), n.by_theory.end());
    squares[n.quantity].first += (*most - *least) * (*most - *least);
    squares[n.quantity].second += n.by_theory.front() * n.by_theory.front();
  }
  double out = 0;
  for (const auto& [quantity, sums] : squares)
    if (sums.second > 0) out = std::max(out, std::sqrt(sums.first / sums.second));
  return out;
}

fit::PredictedPlan predicted(const Subject& s, const Measurements& data, const ValidationOptions& o,
                             const std::vector<fit::Discrepancy>& discrepancies, bool tool_point,
                             const parallel::Work& work) {
  fit::PredictedPlanOptions options;
  options.sigma_u = o.comparison.sigma_u, options.sigma_th = o.comparison.sigma_th;
  options.discrepancies = discrepancies;
  options.tool_point = tool_point;
  return fit::predict(s, without_readings(data), o.fit, options, work);
}

Calibration calibration_of(const Subject& s, const Measurements& validation, const Errors& errors,
                           const ValidationOptions& o, const parallel::Work& work) {
  const Measurements& data = *o.calibration;
  Calibration out{data.origin, data.readings.size()};
  compare::ComparisonOptions as_recorded = o.comparison;
  as_recorded.as_recorded = true;
  const compare::Comparison c = compare::compare(s, data, as_recorded, work);
  const Errors own(c, predicted(s, data, o, {}, true, work), {});
  const auto size = [](const Errors& e) {
    VectorX r = e.residual();
    return compare::rms_of_kept(e.comparison().study.values, r, e.aside());
  };
  out.rms_E = size(own), out.validation_rms_E = size(errors);
  for (const measurement::PoseGroup& p : data.poses)
    out.poses_shared += std::any_of(validation.poses.begin(), validation.poses.end(), [&](const auto& other) {
      return !validation.instruments.stationary && p.pose_mm_deg == other.pose_mm_deg &&
             p.joints.size() == other.joints.size() && (p.joints.size() == 0 || p.joints == other.joints);
    });
  return out;
}

void add_sameness(ValidationStudy& out, const Subject& s, const Errors& errors, const std::vector<Grouping>& groups,
                  const ValidationOptions& o) {
  std::vector<fit::FreeParameter> parameters = o.parameters;
  VectorX values(std::ssize(parameters));
  for (std::size_t i = 0; i < parameters.size(); ++i) values(as_index(i)) = parameters[i].value;
  Subject at = s;
  if (parameters.empty() && o.fit) {
    at = fit::with_values(s, o.fit->parameters, o.fit->values);
    parameters = fit::in_version(o.fit->parameters, o.fit->values);
    values = o.fit->values;
  }
  if (parameters.empty()) return;
  const compare::ResidualStudy& study = errors.comparison().study;
  const MatrixX derivative = fit::derivatives(at, parameters, values, [&](const Subject& moved) {
    prediction::PredictionOptions linear;
    linear.geometry = Geometry::linear;
    return statistics::rows_of(study.values, moved.stand(*study.data)->predict(*study.data, linear));
  });
  out.same = same_everywhere(errors, groups, derivative, parameters);
}

/// Root mean square of σ of that quantity; nullopt where it was not measured.
std::optional<double> sigma_of(const compare::Comparison& c, measurement::Quantity quantity) {
  std::vector<double> all;
  for (std::size_t i = 0; i < c.sigma.size(); ++i)
    if (c.study.values[i].quantity == quantity) all.push_back(c.sigma[i]);
  return all.empty() ? std::nullopt : std::optional(rms(all));
}

std::size_t assumed_numbers(const Subject& s) { return s.machine() ? s.machine()->ours.size() : 0; }

}  // namespace

ValidationStudy validate(const Subject& s, const Measurements& data, const ValidationOptions& o,
                         const parallel::Work& work) {
  if (o.calibration) require_apart(*o.calibration, data);
  const Subject fitted = o.fit ? fit::with_values(s, o.fit->parameters, o.fit->values) : s;
  ValidationStudy out;
  out.device = s.name();
  out.data = data.origin;
  out.comparison = compare::compare(fitted, data, o.comparison, work.part(0, 0.4));
  const fit::PredictedPlan plan = predicted(s, data, o, {}, true, work.part(0.4, 0.5));
  const NumericalStudy numerical = numerical_study(fitted, plan, work.part(0.5, 0.7));
  out.mesh = numerical.orders;
  out.theories_differ = difference_of_theories(plan);
  const Errors errors(out.comparison, plan, numerical.u);
  out.calibrated = o.fit.has_value();
  out.theories = plan.theories.size();
  out.errors = errors.all();
  out.agreement = errors.agreement();
  std::set<std::size_t> channels;
  for (const measurement::MeasuredValue& v : out.comparison.study.values) channels.insert(v.channel);
  for (const std::size_t channel : channels) {
    out.channels.push_back(channel_validity(errors, channel));
    out.u.insert(out.u.end(), out.channels.back().u.begin(), out.channels.back().u.end());
  }
  std::sort(out.u.begin(), out.u.end());
  out.area = area_from_uniform(out.u);
  out.expected_area = expected_area(out.u.size());
  out.discrepancies = discrepancies_of(errors, out.agreement);
  out.domain = ranges(data, o.use);
  const std::vector<Grouping> groups = groupings(errors);
  out.without = leave_out(errors, groups, work.threads);
  add_sameness(out, s, errors, groups, o);
  if (o.calibration) out.calibration = calibration_of(s, data, errors, o, work.part(0.7, 0.9));
  if (o.use) {
    ValidationOptions as_here = o;  // σ of a reading as in validation, where neither sensor nor fit tells it
    as_here.comparison.sigma_u = sigma_of(out.comparison, measurement::Quantity::length);
    as_here.comparison.sigma_th = sigma_of(out.comparison, measurement::Quantity::angle);
    fit::PredictedPlan use = predicted(s, *o.use, as_here, out.discrepancies, false, work.part(0.9, 1));
    out.use = Use{std::move(use), use_points(data, *o.use)};
  }
  out.assumed = assumed_numbers(s);
  return out;
}

}  // namespace deflect::validity
