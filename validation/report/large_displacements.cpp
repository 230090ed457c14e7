#include "validation/report/large_displacements.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

namespace deflect::report {
namespace {

constexpr double largest_turn = 0.1, largest_share = 0.05;

}  // namespace

std::optional<std::string> large_displacement_note(const Displacements& d, Geometry geometry,
                                                   const std::string& remedy) {
  if (geometry == Geometry::finite || d.points.empty()) return {};
  Eigen::AlignedBox3d box;
  for (const Vector3& p : d.points) box.extend(p);
  const double size = box.diagonal().norm();
  double turn = 0, way = 0;
  for (const Vector3& w : d.turned) turn = std::max(turn, w.norm());
  for (const Vector3& u : d.moved) way = std::max(way, u.norm());
  for (const auto& [a, b] : d.lines) {
    const Vector3 along = d.points[b] - d.points[a], apart = d.moved[b] - d.moved[a];
    const double square = along.squaredNorm();
    if (square > 1e-18 * size * size) turn = std::max(turn, along.cross(apart).norm() / square);
  }
  const double share = size > 0 ? way / size : 0;
  if (turn <= largest_turn && share <= largest_share) return {};
  return fmt::format(
      "displacements are not small: parts turn by up to {:.3g} rad and move by up to {:.4g} mm, {:.2g} % of the "
      "structure's size. {} geometry leaves out {:.2g} % of lengths that turn so (θ²/2), and writes equilibrium with "
      "the lever arms {}: {}",
      turn, 1e3 * way, 100 * share, geometry == Geometry::linear ? "Linear" : "Second-order", 50 * turn * turn,
      geometry == Geometry::linear ? "of the unloaded shape" : "to first order in the displacements", remedy);
}

}  // namespace deflect::report
