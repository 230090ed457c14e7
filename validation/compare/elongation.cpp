#include "validation/compare/elongation.h"
#include "msa/base/index.h"

#include <algorithm>
#include <cmath>

namespace deflect::compare {
namespace {

/// Knots over [−1, 1], as many on each side, both ending at 0, where the curve may jump.
double knot(int k, int knots) {
  const int side = knots / 2;
  return k < side ? -1 + static_cast<double>(k) / (side - 1) : static_cast<double>(k - side) / (side - 1);
}

/// Value at x of the piecewise linear function that is 1 at knot k, on its side of 0.
double hat(double x, int k, int knots) {
  const int side = knots / 2;
  if ((k < side) != (x < 0) || x == 0) return 0;
  return std::max(0.0, 1 - std::abs(x - knot(k, knots)) * (side - 1));
}

/// Point by point, without knots that have no data.
void put_point(ElongationCurve& curve, double weight, double force, double elongation, double variance) {
  if (weight < 0.5) return;
  curve.force.push_back(force);
  curve.elongation.push_back(elongation);
  curve.deviation.push_back(std::sqrt(std::max(0.0, variance)));
}

}  // namespace

std::vector<ElongationCurve> elongation_curves(const ResidualStudy& s, const statistics::Uncertainty& u,
                                               const VectorX& r, int knots) {
  std::vector<ElongationCurve> out;
  const std::size_t sites = s.sites.front().size();
  if (sites == 0) return out;
  VectorX most = VectorX::Zero(as_index(sites));
  for (const VectorX& f : s.force) most = most.cwiseMax(f.cwiseAbs());
  const Eigen::Index columns = as_index(sites) * knots;
  VectorX weight = VectorX::Zero(columns);  // how often a knot was near
  MatrixX hats(columns, std::ssize(s.force));
  for (std::size_t i = 0; i < s.force.size(); ++i) {
    const auto reading = as_index(i);
    for (std::size_t k = 0; k < sites; ++k) {
      const auto at = as_index(k);
      const double x = most(at) > 0 ? s.force[i](at) / most(at) : 0;
      for (int j = 0; j < knots; ++j) hats(at * knots + j, reading) = hat(x, j, knots);
    }
    weight += hats.col(reading);
  }
  MatrixX shapes(std::ssize(s.values), columns);
  for (std::size_t n = 0; n < s.values.size(); ++n) {
    const measurement::MeasuredValue& v = s.values[n];
    const std::vector<subject::Site>& own = s.sites[s.data->readings[v.reading].pose];
    for (Eigen::Index c = 0; c < columns; ++c)
      shapes(as_index(n), c) = hats(c, as_index(v.reading)) * v.form.dot(nth(own, c / knots).g);
  }
  hats.resize(0, 0);
  const statistics::Regression fit = statistics::regress(u, r, shapes);
  for (std::size_t k = 0; k < sites; ++k) {
    const subject::Site& site = s.sites.front()[k];
    ElongationCurve curve{site.name, site.rotation, {}, {}, {}};
    for (int j = 0; j < knots; ++j) {
      const Eigen::Index column = as_index(k) * knots + j;
      put_point(curve, weight(column), most(as_index(k)) * knot(j, knots), fit.amplitude(column),
                fit.covariance(column, column));
    }
    if (!curve.force.empty()) out.push_back(std::move(curve));
  }
  return out;
}

ElongationCurve curve_of(const statistics::Regressions& fits,
                         const std::function<VectorX(const std::function<double(double)>&)>& rows, const VectorX& force,
                         const std::string& name, bool rotation, int knots) {
  const double most = force.cwiseAbs().maxCoeff();
  ElongationCurve curve{name, rotation, {}, {}, {}};
  VectorX weight = VectorX::Zero(knots);
  MatrixX shapes;
  for (int j = 0; j < knots; ++j) {
    const auto at = [&](double f) { return hat(f / most, j, knots); };
    const VectorX column = rows(at);
    if (j == 0) shapes.resize(column.size(), knots);
    shapes.col(j) = column;
    weight(j) = force.unaryExpr(at).sum();
  }
  const statistics::Regression fit = fits.on(shapes);
  for (int j = 0; j < knots; ++j)
    put_point(curve, weight(j), most * knot(j, knots), fit.amplitude(j), fit.covariance(j, j));
  return curve;
}

}  // namespace deflect::compare
