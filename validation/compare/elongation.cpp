#include "validation/compare/elongation.h"

#include <algorithm>
#include <cmath>

namespace deflect {
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

}  // namespace

std::vector<ElongationCurve> elongation_curves(const ResidualStudy& s, const Uncertainty& u, const VectorX& r,
                                               int knots) {
  std::vector<ElongationCurve> out;
  const std::size_t sites = s.sites.front().size();
  if (sites == 0) return out;
  VectorX most = VectorX::Zero(static_cast<Eigen::Index>(sites));
  for (const VectorX& f : s.force) most = most.cwiseMax(f.cwiseAbs());
  const Eigen::Index columns = static_cast<Eigen::Index>(sites) * knots;
  std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>> by_reading;
  VectorX weight = VectorX::Zero(columns);  // how often a knot was near
  for (std::size_t i = 0; i < s.force.size(); ++i) {
    Eigen::Matrix<double, 6, Eigen::Dynamic> block(6, columns);
    for (std::size_t k = 0; k < sites; ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      const double x = most(at) > 0 ? s.force[i](at) / most(at) : 0;
      for (int j = 0; j < knots; ++j) {
        const double h = hat(x, j, knots);
        block.col(at * knots + j) = h * s.sites[s.data->readings[i].pose][k].g;
        weight(at * knots + j) += h;
      }
    }
    by_reading.push_back(std::move(block));
  }
  const Regression fit = regress(u, r, rows_of(s.values, by_reading));
  for (std::size_t k = 0; k < sites; ++k) {
    const Site& site = s.sites.front()[k];
    ElongationCurve curve{site.name, site.rotation, {}, {}, {}};
    for (int j = 0; j < knots; ++j) {
      const Eigen::Index column = static_cast<Eigen::Index>(k) * knots + j;
      if (weight(column) < 0.5) continue;
      curve.force.push_back(most(static_cast<Eigen::Index>(k)) * knot(j, knots));
      curve.elongation.push_back(fit.amplitude(column));
      curve.deviation.push_back(std::sqrt(std::max(0.0, fit.covariance(column, column))));
    }
    out.push_back(std::move(curve));
  }
  return out;
}

}  // namespace deflect
