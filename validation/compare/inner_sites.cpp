#include "validation/compare/inner_sites.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "validation/compare/yielding.h"

namespace deflect::compare {
namespace {

constexpr std::size_t most_curves = 6;  // curves
constexpr int curve_knots = 10;

double sense(double f) { return f > 0 ? 1 : f < 0 ? -1 : 0; }

constexpr double no_force = 1e-9;  // of the largest

/// 0 where it is rounding.
VectorX forces_at(const ResidualStudy& s, const subject::InnerSite& site) {
  const VectorX f = s.loads.transpose() * site.per_load;
  return (f.array().abs() > no_force * f.cwiseAbs().maxCoeff()).select(f, 0);
}

}  // namespace

MatrixX inner_forces(const ResidualStudy& s) {
  MatrixX per_load(std::ssize(s.inner.all), s.loads.rows());
  for (std::size_t k = 0; k < s.inner.all.size(); ++k) per_load.row(as_index(k)) = s.inner.all[k].per_load.transpose();
  return per_load * s.loads;
}

VectorX change_by_yielding(const ResidualStudy& s, const subject::InnerSite& site,
                           const std::function<double(double)>& elongation) {
  const VectorX longer = forces_at(s, site).unaryExpr(elongation);
  VectorX out(std::ssize(s.values));
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    const measurement::MeasuredValue& v = s.values[i];
    out(as_index(i)) = site.moves(as_index(v.channel) - 6) * longer(as_index(v.reading));
  }
  return out;
}

MatrixX changes_by_yielding(const ResidualStudy& s, const subject::InnerSite& site) {
  const double most = forces_at(s, site).cwiseAbs().maxCoeff();
  const auto shape = [&](const auto& e) { return change_by_yielding(s, site, e); };
  MatrixX out(std::ssize(s.values), 3);
  out << shape([](double f) { return f; }), shape([](double f) { return std::abs(f); }), most * shape(sense);
  return out;
}

InnerFits fits_of_inner_sites(const ResidualStudy& s, const statistics::Uncertainty& u, const VectorX& residual) {
  InnerFits out;
  if (s.inner.all.empty()) return out;
  const MatrixX forces = inner_forces(s);
  const statistics::Regressions fits(u, residual);
  const double beyond = std::max(1.0, u.inner(residual, residual)(0, 0) - static_cast<double>(u.count()));
  std::vector<std::size_t> number;  // of each fit the site
  for (std::size_t k = 0; k < s.inner.all.size(); ++k) {
    const subject::InnerSite& site = s.inner.all[k];
    const double most = forces.row(as_index(k)).cwiseAbs().maxCoeff();
    const MatrixX shapes = changes_by_yielding(s, site);
    const MatrixX whitened = fits.whitened(shapes);
    if (!(most > 0) || !(whitened.norm() > 0)) continue;
    const statistics::Regression all = fits.on_whitened(whitened), line = fits.on_whitened(whitened.leftCols(1));
    InnerSiteFit fit{site.name, site.rotation, site.determinate, site.redundancy, most};
    fit.gain = all.gain, fit.freedoms = all.freedoms, fit.p_value = all.p_value;
    fit.share = std::min(1.0, all.gain / beyond);
    fit.per_force = line.amplitude(0), fit.deviation = std::sqrt(std::max(0.0, line.covariance(0, 0)));
    out.all.push_back(std::move(fit));
    number.push_back(k);
  }
  std::vector<std::size_t> order(out.all.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return out.all[a].gain > out.all[b].gain; });
  for (std::size_t i = 0; i < std::min(most_curves, order.size()); ++i) {
    const InnerSiteFit& fit = out.all[order[i]];
    const std::size_t k = number[order[i]];
    const VectorX passes = forces.row(as_index(k)).transpose();
    const auto shape = [&](const auto& e) { return change_by_yielding(s, s.inner.all[k], e); };
    const std::string known = fit.determinate ? "by statics" : "as shared";
    out.curves.push_back(curve_of(fits, shape, passes, fit.site + ", " + known, fit.rotation, curve_knots));
  }
  std::vector<InnerSiteFit> sorted;
  for (const std::size_t i : order) sorted.push_back(std::move(out.all[i]));
  out.all = std::move(sorted);
  return out;
}

VectorX residual_forces(const ResidualStudy& s, const std::vector<double>& sigma, const MatrixX& A,
                        const VectorX& residual, std::size_t reading) {
  const auto sites = std::ssize(s.inner.all);
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < s.values.size(); ++i)
    if (s.values[i].reading == reading) rows.push_back(as_index(i));
  if (sites == 0 || rows.empty()) return VectorX::Zero(sites);
  const VectorX f = inner_forces(s).col(as_index(reading));
  VectorX scale = VectorX::Zero(sites);  // of a member its elastic elongation
  for (Eigen::Index k = 0; k < sites; ++k) {
    const subject::InnerSite& site = nth(s.inner.all, k);
    const double holds = -s.inner.response(k, k);
    if (!site.determinate && site.redundancy > 0) scale(k) = std::abs(f(k)) * site.redundancy / holds;
  }
  MatrixX moves(std::ssize(rows), sites), variance = MatrixX::Zero(std::ssize(rows), std::ssize(rows));
  VectorX r(std::ssize(rows));
  for (Eigen::Index i = 0; i < r.size(); ++i) {
    const measurement::MeasuredValue& v = nth(s.values, nth(rows, i));
    r(i) = residual(nth(rows, i));
    for (Eigen::Index k = 0; k < sites; ++k) moves(i, k) = nth(s.inner.all, k).moves(as_index(v.channel) - 6);
    for (Eigen::Index j = 0; j < r.size(); ++j) variance(i, j) = A.row(nth(rows, i)).dot(A.row(nth(rows, j)));
    variance(i, i) += nth(sigma, nth(rows, i)) * nth(sigma, nth(rows, i));
  }
  const MatrixX prior = scale.cwiseAbs2().asDiagonal();
  const VectorX e = prior * moves.transpose() * (moves * prior * moves.transpose() + variance).ldlt().solve(r);
  return s.inner.response * e;
}

}  // namespace deflect::compare
