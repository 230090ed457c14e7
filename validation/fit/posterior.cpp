#include "validation/fit/posterior.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/compare/held_out.h"

namespace deflect::fit {
namespace {

/// Variance of the coordinate before the data, and its mean from the fitted value.
std::pair<double, double> prior_of(const FreeParameter& p, double value) {
  const double x = p.coordinate(value);
  if (p.prior) {
    const double deviation = p.positive ? p.prior->deviation / p.prior->mean : p.prior->deviation;
    return {deviation * deviation, p.coordinate(p.prior->mean) - x};
  }
  const double range = search_range(p);
  return {range * range / 12, 0};
}

}  // namespace

MatrixX derivatives(const subject::Subject& s, const std::vector<FreeParameter>& all, const VectorX& values,
                    const std::function<VectorX(const subject::Subject&)>& prediction) {
  const Freed freed(all);
  const effects::PreparedEffects prepared(s, freed.hypothesis());
  const auto at = [&](const VectorX& there) {
    return outcome_of([&] { return prediction(prepared(freed.effect_values(there))); });
  };
  std::optional<VectorX> here;
  MatrixX out;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const FreeParameter& p = nth(all, i);
    const double step = 1e-5 * p.scale();
    const auto moved = [&](double by) {
      VectorX there = values;
      there(i) = p.value_at(p.coordinate(values(i)) + by);
      return at(there);
    };
    const auto up = moved(step), down = moved(-step);
    if (!up && !down) throw NumericalError("beside the fitted values nothing can be predicted: " + up.why);
    if (!(up && down) && !here) here = prediction(prepared(freed.effect_values(values)));
    const VectorX column = (up ? *up : *here) - (down ? *down : *here);
    if (out.size() == 0) out.resize(column.size(), values.size());
    out.col(i) = column / (up && down ? 2 * step : step);
  }
  return out;
}

Learnt::Learnt(const diagnosis::Observations& o, const std::vector<FreeParameter>& all, const VectorX& values)
    : observations_(&o) {
  const auto residual = [&o](const subject::Subject& each) { return o.residual(each); };
  const Freed freed(all);
  residual_ = residual(effects::PreparedEffects(o.subject(), freed.hypothesis())(freed.effect_values(values)));
  P_ = -derivatives(o.subject(), all, values, residual);
  const auto k = std::ssize(all);
  VectorX scales(k);
  for (Eigen::Index i = 0; i < k; ++i) scales(i) = nth(all, i).scale();
  const statistics::Uncertainty& u = o.uncertainty();
  whitened_ = u.whitened(P_ * scales.asDiagonal());
  const MatrixX& A = u.tolerances().shared;
  columns_.resize(P_.rows(), k + A.cols());
  columns_ << P_, A;
  B_ = u.whitening()->within_groups(columns_);
  z_ = u.whitening()->within_groups(residual_);
  prior_ = MatrixX::Identity(columns_.cols(), columns_.cols());
  prior_score_ = VectorX::Zero(columns_.cols());
  for (Eigen::Index i = 0; i < k; ++i) {
    const auto [variance, mean] = prior_of(nth(all, i), values(i));
    prior_(i, i) = 1 / variance;
    prior_score_(i) = mean / variance;
  }
  const Eigen::LLT<MatrixX> information(prior_ + B_.transpose() * B_);
  posterior_ = {k, information.solve(prior_score_ + B_.transpose() * z_),
                information.solve(MatrixX::Identity(columns_.cols(), columns_.cols()))};
}

VectorX Learnt::variance_of_noise() const {
  const compare::Comparison& c = observations_->comparison();
  VectorX out = c.study.load_errors.deviations(c.study.values).cwiseAbs2();
  for (std::size_t i = 0; i < c.sigma.size(); ++i) out(as_index(i)) += c.sigma[i] * c.sigma[i];
  for (const statistics::GroupColumns& group : observations_->uncertainty().tolerances().groups)
    for (std::size_t i = 0; i < group.rows.size(); ++i)
      out(group.rows[i]) += group.columns.row(as_index(i)).squaredNorm();
  return out;
}

HeldOutNumbers Learnt::held_out() const {
  const compare::ResidualStudy& s = observations_->comparison().study;
  const std::vector<std::size_t> group = compare::held_out_groups(s);
  const std::size_t folds = std::min<std::size_t>(10, 1 + *std::max_element(group.begin(), group.end()));
  std::vector<std::vector<Eigen::Index>> rows(folds);
  for (std::size_t i = 0; i < s.values.size(); ++i)
    if (!observations_->aside()[s.values[i].reading]) rows[group[s.values[i].reading] % folds].push_back(as_index(i));
  const MatrixX information = prior_ + B_.transpose() * B_;
  const VectorX score = prior_score_ + B_.transpose() * z_;
  HeldOutNumbers out{VectorX::Zero(residual_.size()), variance_of_noise()};
  for (const std::vector<Eigen::Index>& own : rows) {
    const MatrixX B = B_(own, Eigen::all), columns = columns_(own, Eigen::all);
    const bool alone = folds == 1;  // nothing else teaches
    const Eigen::LLT<MatrixX> others(alone ? information : MatrixX(information - B.transpose() * B));
    const VectorX mean = others.solve(alone ? score : VectorX(score - B.transpose() * z_(own)));
    out.residual(own) = residual_(own) - columns * mean;
    const MatrixX root = others.matrixL().solve(columns.transpose());
    for (std::size_t i = 0; i < own.size(); ++i) out.variance(own[i]) += root.col(as_index(i)).squaredNorm();
  }
  for (std::size_t i = 0; i < s.values.size(); ++i)
    if (observations_->aside()[s.values[i].reading]) out.variance(as_index(i)) = 0;
  return out;
}

double size_of_prediction(const std::vector<measurement::MeasuredValue>& values, const VectorX& predicted,
                          std::size_t reading, measurement::Quantity quantity) {
  double squares = 0;
  int n = 0;
  auto first = std::lower_bound(values.begin(), values.end(), reading,
                                [](const measurement::MeasuredValue& v, std::size_t r) { return v.reading < r; });
  for (; first != values.end() && first->reading == reading; ++first) {
    if (first->quantity != quantity) continue;
    const double p = predicted(first - values.begin());
    squares += p * p;
    ++n;
  }
  return n > 0 ? std::sqrt(squares / n) : 0;
}

std::vector<Discrepancy> discrepancies(const diagnosis::Observations& o, const HeldOutNumbers& held) {
  const compare::ResidualStudy& s = o.comparison().study;
  const VectorX predicted = statistics::rows_of(s.values, s.predicted);
  struct Sums {
    double excess = 0, squares = 0;
  };
  std::map<measurement::Quantity, Sums> sums;
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    const auto row = as_index(i);
    if (o.aside()[s.values[i].reading]) continue;
    const double size = size_of_prediction(s.values, predicted, s.values[i].reading, s.values[i].quantity);
    Sums& sum = sums[s.values[i].quantity];
    sum.excess += held.residual(row) * held.residual(row) - held.variance(row);
    sum.squares += size * size;
  }
  std::vector<Discrepancy> out;
  for (const auto& [quantity, sum] : sums)
    out.push_back({quantity, sum.squares > 0 ? std::sqrt(std::max(0.0, sum.excess) / sum.squares) : 0});
  return out;
}

}  // namespace deflect::fit
