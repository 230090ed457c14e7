#include "msa/mechanism/sections/thin_walls.h"

#include <Eigen/LU>
#include <cmath>

namespace deflect {

double shear_area(const std::vector<Wall>& walls, Eigen::Index axis) {
  double area = 0;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (const Wall& w : walls) {
    const double dA = w.thickness * (w.to - w.from).norm();
    area += dA;
    moment += dA * (w.from + w.to) / 2;
  }
  const Eigen::Vector2d centroid = moment / area;

  // S is quadratic along a wall and S Sᵀ of fourth degree: three points of Gauss are exact.
  const double offset = std::sqrt(0.15), points[] = {0.5 - offset, 0.5, 0.5 + offset},
               weights[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  Eigen::Matrix2d M = Eigen::Matrix2d::Zero(), energy = M;
  std::vector<Eigen::Vector2d> at_end;
  for (const Wall& w : walls) {
    const double length = (w.to - w.from).norm(), dA = w.thickness * length;
    const Eigen::Vector2d r = w.from - centroid, change = w.to - w.from;
    Eigen::Vector2d before = Eigen::Vector2d::Zero();
    for (const std::size_t i : w.before) before += at_end[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = points[k];
      const Eigen::Vector2d S = before + dA * x * (r + change * x / 2), at = r + change * x;
      energy += weights[k] * length / w.thickness * S * S.transpose();
      M += weights[k] * dA * at * at.transpose();
    }
    at_end.push_back(before + dA * (r + change / 2));
  }
  const Eigen::Matrix2d inverse = M.inverse();
  return 1 / (inverse * energy * inverse)(axis, axis);
}

}  // namespace deflect
