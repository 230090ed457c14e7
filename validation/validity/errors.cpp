#include "validation/validity/errors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "msa/base/index.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/tail.h"

namespace deflect::validity {
namespace {

/// For each measured number its predicted one.
std::vector<std::size_t> matched(const compare::Comparison& c, const fit::PredictedPlan& plan) {
  std::map<std::pair<std::size_t, std::string>, std::size_t> known;
  for (std::size_t i = 0; i < plan.numbers.size(); ++i)
    known[{plan.numbers[i].reading, measurement::channel_name(plan.plan, plan.numbers[i].channel)}] = i;
  std::vector<std::size_t> out;
  for (const measurement::MeasuredValue& v : c.study.values)
    out.push_back(known.at({v.reading, measurement::channel_name(*c.study.data, v.channel)}));
  return out;
}

/// The rows of these numbers, in this order.
statistics::PartedColumns rows_of(const statistics::PartedColumns& all, const std::vector<std::size_t>& rows) {
  statistics::PartedColumns out;
  std::vector<Eigen::Index> index;
  for (const std::size_t i : rows) index.push_back(as_index(i));
  out.shared = all.shared(index, Eigen::all);
  for (const statistics::GroupColumns& group : all.groups) {
    std::map<Eigen::Index, Eigen::Index> at;
    for (std::size_t i = 0; i < group.rows.size(); ++i) at[group.rows[i]] = as_index(i);
    statistics::GroupColumns own;
    std::vector<Eigen::Index> taken;
    for (std::size_t i = 0; i < index.size(); ++i)
      if (const auto found = at.find(index[i]); found != at.end())
        own.rows.push_back(as_index(i)), taken.push_back(found->second);
    own.columns = group.columns(taken, Eigen::all);
    out.groups.push_back(std::move(own));
  }
  return out;
}

Agreement agreement_of(double chi2, std::size_t numbers) {
  return {chi2, numbers, numbers > 0 ? statistics::chi_squared_tail(static_cast<double>(numbers), chi2) : 1};
}

}  // namespace

double ComparisonError::u_D() const { return std::hypot(noise, load); }
double ComparisonError::u_val() const { return std::sqrt(num * num + input * input + u_D() * u_D()); }

Errors::Errors(const compare::Comparison& c, const fit::PredictedPlan& plan, const std::vector<double>& numerical)
    : comparison_(&c) {
  const std::vector<std::size_t> match = matched(c, plan);
  const std::set<std::size_t> lines(c.set_aside.begin(), c.set_aside.end());
  for (const measurement::Reading& r : c.study.data->readings) aside_.push_back(lines.contains(r.line));
  residual_.resize(std::ssize(match));
  for (std::size_t i = 0; i < match.size(); ++i) {
    const fit::PredictedNumber& n = plan.numbers[match[i]];
    ComparisonError e{n.value, c.study.values[i].value};
    e.num = numerical.empty() ? 0 : numerical[match[i]];
    e.input = std::hypot(n.deviation.parameters, n.deviation.tolerances);
    e.noise = c.sigma[i];
    e.load = n.deviation.load;
    residual_(as_index(i)) = -e.E();
    sigma_.push_back(std::hypot(e.noise, e.num));
    errors_.push_back(e);
  }
  columns_ = rows_of(plan.errors, match);
  zeros_.resize(residual_.size(), 0);
  for (std::size_t k = 0; k < c.tolerances.nuisances.size(); ++k)
    if (c.tolerances.nuisances[k].zero)
      zeros_ = statistics::side_by_side({zeros_, c.tolerances.A.shared.col(as_index(k))}, residual_.size());
  const Eigen::Index known = columns_.shared.cols();
  columns_.shared = statistics::side_by_side({columns_.shared, zeros_}, residual_.size());
  uncertainty_ = std::make_shared<const statistics::Uncertainty>(weighed(aside_));
  const VectorX zero = zeros_ * uncertainty_->nuisances(residual_).segment(known, zeros_.cols());
  for (std::size_t i = 0; i < errors_.size(); ++i) errors_[i].D -= zero(as_index(i));
}

statistics::Uncertainty Errors::weighed(const std::vector<bool>& aside) const {
  const compare::ResidualStudy& s = comparison_->study;
  return {columns_, s.values, sigma_, s.load_errors, aside};
}

bool Errors::counts(std::size_t number) const { return !aside_[comparison_->study.values[number].reading]; }

VectorX Errors::residual() const {
  VectorX out(std::ssize(errors_));
  for (std::size_t i = 0; i < errors_.size(); ++i) out(as_index(i)) = -errors_[i].E();
  return out;
}

/// Zeros that these numbers determine: each takes one degree of freedom.
std::size_t Errors::zeros(const std::vector<std::size_t>& numbers) const {
  std::size_t out = 0;
  for (Eigen::Index k = 0; k < zeros_.cols(); ++k)
    out += std::any_of(numbers.begin(), numbers.end(), [&](std::size_t i) { return zeros_(as_index(i), k) != 0; });
  return out;
}

Agreement Errors::agreement(const std::vector<bool>& without) const {
  std::vector<bool> aside = aside_;
  for (std::size_t i = 0; i < without.size(); ++i) aside[i] = aside[i] || without[i];
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < errors_.size(); ++i)
    if (!aside[comparison_->study.values[i].reading]) numbers.push_back(i);
  const double chi2 = (without.empty() ? *uncertainty_ : weighed(aside)).whitened(residual_).squaredNorm();
  return agreement_of(chi2, numbers.size() - std::min(numbers.size(), zeros(numbers)));
}

Agreement Errors::agreement_of_channel(std::size_t channel) const {
  const compare::ResidualStudy& s = comparison_->study;
  std::vector<std::size_t> numbers;
  std::vector<measurement::MeasuredValue> values;
  std::vector<double> sigma;
  VectorX r(residual_.size());
  for (std::size_t i = 0; i < s.values.size(); ++i)
    if (s.values[i].channel == channel && counts(i)) {
      r(std::ssize(numbers)) = residual_(as_index(i));
      numbers.push_back(i);
      values.push_back(s.values[i]);
      sigma.push_back(sigma_[i]);
    }
  if (numbers.empty()) return {};
  const statistics::Uncertainty own(rows_of(columns_, numbers), values, sigma, s.load_errors);
  const double chi2 = own.whitened(r.head(std::ssize(numbers))).squaredNorm();
  return agreement_of(chi2, numbers.size() - std::min(numbers.size(), zeros(numbers)));
}

}  // namespace deflect::validity
