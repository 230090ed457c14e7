#include "tests/benchmark/baselines.h"

#include <Eigen/QR>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

namespace deflect::benchmark {
namespace {

using namespace compare;
using namespace statistics;

using Changes = std::vector<const Change*>;
using Decomposition = Eigen::CompleteOrthogonalDecomposition<MatrixX>;

/// Least squares of the whitened residual on the whitened changes of one effect.
struct AlongSignature {
  VectorX amplitude;  ///< in units of the start
  double gain = 0;    ///< in χ²
};
AlongSignature along(const MatrixX& change, const VectorX& residual) {
  AlongSignature out;
  out.amplitude = Decomposition(change).solve(residual);
  out.gain = (change * out.amplitude).dot(residual);
  return out;
}

/// The effect's name as a verdict, with what it does at the new poses.
BaselineAnswer named(const Change& c, const VectorX& amplitude, double probability) {
  const std::string& name = c.effect.effect->name;
  return {{"effect", {name}, {}, name, probability}, c.elsewhere * amplitude};
}

BaselineAnswer nothing(const Plan& plan) { return {{}, VectorX::Zero(plan.nominal_elsewhere.size())}; }

BaselineAnswer fixed_nuisances(const Plan& plan, const Changes& changes, const Uncertainty& noise,
                               const VectorX& residual) {
  const VectorX r = noise.whitened(residual);
  double least = 0.05, gain = 0;
  BaselineAnswer out = nothing(plan);
  for (const Change* c : changes) {
    const AlongSignature a = along(noise.whitened(c->measured), r);
    const boost::math::chi_squared chance(static_cast<double>(a.amplitude.size()));
    const double p = a.gain > 0 ? boost::math::cdf(boost::math::complement(chance, a.gain)) : 1;
    if (p > least || (p == least && a.gain < gain)) continue;
    least = p;
    gain = a.gain;
    out = named(*c, a.amplitude, 1 - p);
  }
  return out;
}

BaselineAnswer all_parameters(const Plan& plan, const Changes& changes, const Uncertainty& noise,
                              const VectorX& residual) {
  const MatrixX tolerances = plan.observations->comparison().tolerances.A.dense();
  Eigen::Index columns = tolerances.cols();
  for (const Change* c : changes) columns += c->measured.cols();
  MatrixX all(residual.size(), columns);
  all.leftCols(tolerances.cols()) = tolerances;
  Eigen::Index at = tolerances.cols();
  for (const Change* c : changes) {
    all.middleCols(at, c->measured.cols()) = c->measured;
    at += c->measured.cols();
  }
  all = noise.whitened(all);
  const VectorX length = all.colwise().norm().cwiseMax(1e-12).transpose();
  Decomposition least_squares;
  least_squares.setThreshold(1e-3);
  least_squares.compute(all * length.cwiseInverse().asDiagonal());
  const MatrixX inverse = length.cwiseInverse().asDiagonal() * least_squares.pseudoInverse();
  const VectorX amplitude = inverse * noise.whitened(residual), deviation = inverse.rowwise().norm();
  double largest = 1.96;
  BaselineAnswer out = nothing(plan);
  VectorX beyond = out.elsewhere;
  at = tolerances.cols();
  for (const Change* c : changes) {
    const VectorX own = amplitude.segment(at, c->measured.cols());
    for (Eigen::Index i = 0; i < own.size(); ++i)
      if (const double t = std::abs(own(i)) / std::max(deviation(at + i), 1e-300); t > largest) {
        largest = t;
        out = named(*c, own, 1);
      }
    beyond += c->elsewhere * own;
    at += c->measured.cols();
  }
  out.elsewhere = beyond;  // it predicts with all that it has fitted
  return out;
}

BaselineAnswer bic(const Plan& plan, const Changes& changes, const VectorX& residual) {
  const Uncertainty& u = plan.observations->uncertainty();
  const VectorX r = u.whitened(residual);
  const double price = std::log(static_cast<double>(r.size()));
  double most = 0;
  BaselineAnswer out = nothing(plan);
  std::vector<double> gains;
  for (const Change* c : changes) {
    const AlongSignature a = along(u.whitened(c->measured), r);
    const double gain = a.gain - price * static_cast<double>(a.amplitude.size());
    gains.push_back(gain);
    if (gain <= most) continue;
    most = gain;
    out = named(*c, a.amplitude, 0);
  }
  double sum = std::exp(-most / 2);  // of nothing
  for (const double gain : gains) sum += std::exp((gain - most) / 2);
  if (!out.answer.missing.empty()) out.answer.probability = 1 / sum;
  return out;
}

}  // namespace

std::vector<BaselineAnswer> baselines(const Plan& plan, const VectorX& residual, const std::string& left_out) {
  Changes changes;
  for (const Change& c : plan.changes)
    if (c.effect.effect->name != left_out) changes.push_back(&c);
  const Comparison& known = plan.observations->comparison();
  const Uncertainty noise(PartedColumns(MatrixX(residual.size(), 0)), known.study.values, known.sigma,
                          known.study.load_errors);
  return {fixed_nuisances(plan, changes, noise, residual), all_parameters(plan, changes, noise, residual),
          bic(plan, changes, residual)};
}

}  // namespace deflect::benchmark
