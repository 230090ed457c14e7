#include "validation/studies/workspace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/stand.h"
#include "validation/measurement/random.h"

namespace deflect::studies {
namespace {

using Point2 = Eigen::Vector2d;
constexpr double on_the_rim = 1e-9;  // of the region's size: rounding takes no point off its own rim

bool stands(const Mechanism& m, const Vector6& mm_deg) {
  return bool(outcome_of<ModelError>([&] { return configure(m, pose_from(mm_deg)); }));
}

/// How poses are named where the file of the device names none, by command.
constexpr const char* poses_of_ones_own =
    "name poses of your own (validate: --points FILE; map: --x, --y, --z; simulate: --campaign FILE; plan: --before "
    "FILE)";

/// 1 for the axes of the base along which the tool moves a little, without turning, from where it is.
Vector3 free_axes(const Mechanism& m, const Vector6& at_mm_deg, double step_mm) {
  Vector3 free = Vector3::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Vector6 step = step_mm * Vector6::Unit(i);
    free(i) = stands(m, at_mm_deg + step) || stands(m, at_mm_deg - step) ? 1 : 0;
  }
  return free;
}

void set_box(Region& r, const Vector3& half_mm) {
  r.low_mm = r.centre_mm_deg.head<3>() - half_mm;
  r.high_mm = r.centre_mm_deg.head<3>() + half_mm;
}

void shape(Region& r, const CubeSpace& cube, const Mechanism& m) {
  if (!(cube.edge > 0))
    throw InputError(fmt::format(
        "{}: the device has no workspace; add for example 'workspace: {{cube_edge: 50 mm}}' to its file, or {}", m.name,
        poses_of_ones_own));
  const double half = 1e3 * cube.edge / 2;
  const Vector3 free = free_axes(m, r.centre_mm_deg, 0.01 * half);
  if (free.isZero(0) && !actuators_of(m).empty())
    throw ModelError(
        fmt::format("{}: from the centre of its workspace the tool moves along no axis of the base without turning: "
                    "name its poses, as in 'workspace: {{poses: [{{shift: [100 mm, 0 mm, 0 mm], turn: [0 deg, 0 deg, "
                    "30 deg]}}]}}', or {}",
                    m.name, poses_of_ones_own));
  r.words = "cube";
  set_box(r, half * free);
}

void shape(Region& r, const BoxSpace& box, const Mechanism&) {
  r.words = "box";
  set_box(r, 1e3 * box.edges / 2);
}

void shape(Region& r, const DiscSpace& disc, const Mechanism&) {
  r.radius_mm = 1e3 * disc.radius;
  r.words = fmt::format("disc of radius {:g} mm", *r.radius_mm);
  set_box(r, Vector3(*r.radius_mm, *r.radius_mm, 0));
}

void shape(Region& r, const CylinderSpace& c, const Mechanism&) {
  r.radius_mm = 1e3 * c.radius;
  r.words = fmt::format("cylinder of radius {:g} mm", *r.radius_mm);
  set_box(r, Vector3(*r.radius_mm, *r.radius_mm, 1e3 * c.height / 2));
}

/// Centroid of the area; of corners without one their mean.
Point2 centroid(const std::vector<Point2>& corners) {
  double area = 0;
  Point2 sum = Point2::Zero(), mean = Point2::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point2 a = corners[i] - corners[0], b = corners[(i + 1) % corners.size()] - corners[0];
    const double cross = a.x() * b.y() - a.y() * b.x();
    area += cross / 2;
    sum += cross / 6 * (a + b);
    mean += corners[i] / static_cast<double>(corners.size());
  }
  return area != 0 ? Point2(corners[0] + sum / area) : mean;
}

void shape(Region& r, const PolygonSpace& polygon, const Mechanism&) {
  r.words = fmt::format("polygon of {} corners", polygon.corners.size());
  for (const PolygonSpace::Corner& c : polygon.corners) r.corners_mm.emplace_back(1e3 * c.x, 1e3 * c.y);
  if (polygon.z) r.centre_mm_deg(2) = 1e3 * *polygon.z;
  r.centre_mm_deg.head<2>() = centroid(r.corners_mm);
  r.low_mm = r.high_mm = r.centre_mm_deg.head<3>();
  for (const Point2& c : r.corners_mm) {
    r.low_mm.head<2>() = r.low_mm.head<2>().cwiseMin(c);
    r.high_mm.head<2>() = r.high_mm.head<2>().cwiseMax(c);
  }
}

void shape(Region& r, const PoseSpace& list, const Mechanism&) {
  r.words = "list of poses";
  for (const Placement& each : list.poses) {
    Vector6 at;
    at << 1e3 * each.shift, each.turn * 180 / pi;
    r.poses_mm_deg.push_back(at);
  }
  r.centre_mm_deg = r.poses_mm_deg.front();
  r.low_mm = r.high_mm = r.centre_mm_deg.head<3>();
  for (const Vector6& at : r.poses_mm_deg) {
    r.low_mm = r.low_mm.cwiseMin(at.head<3>());
    r.high_mm = r.high_mm.cwiseMax(at.head<3>());
  }
}

/// Even–odd rule; the rim belongs to it.
bool within(const std::vector<Point2>& corners, const Point2& p, double rim) {
  bool inside = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point2 &a = corners[i], &b = corners[(i + 1) % corners.size()], along = b - a;
    const double length = along.norm(), t = length > 0 ? std::clamp((p - a).dot(along) / (length * length), 0., 1.) : 0;
    if ((p - (a + t * along)).norm() <= rim) return true;
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (p.y() - a.y()) / along.y() * along.x()) inside = !inside;
  }
  return inside;
}

/// Signs of the corners of a box; 0 along an axis in which it is flat, and then no corner twice.
std::vector<Vector3> corner_signs(const Vector3& extent) {
  std::vector<Vector3> out;
  const Vector3 has = (extent.array() > 0).cast<double>();
  for (const double z : {+1.0, -1.0})
    for (const auto& [x, y] : {std::pair{+1, +1}, {-1, +1}, {-1, -1}, {+1, -1}})
      if (const Vector3 sign = has.cwiseProduct(Vector3(x, y, z));
          !sign.isZero(0) && std::find(out.begin(), out.end(), sign) == out.end())
        out.push_back(sign);
  return out;
}

}  // namespace

bool Region::holds(const Vector3& mm) const {
  const double rim = on_the_rim * (high_mm - low_mm).norm();
  if (((mm - low_mm).array() < -rim).any() || ((mm - high_mm).array() > rim).any()) return false;
  if (radius_mm) return (mm - centre_mm_deg.head<3>()).head<2>().norm() <= *radius_mm + rim;
  return corners_mm.empty() || within(corners_mm, mm.head<2>(), rim);
}

Region region_of(const Mechanism& m) {
  Region r;
  const auto& centre = m.workspace.centre;
  if (centre)
    r.centre_mm_deg << 1e3 * centre->shift, centre->turn * 180 / pi;
  else if (!std::holds_alternative<PoseSpace>(m.workspace.shape))
    r.centre_mm_deg = mm_deg_from(home_pose(m));
  std::visit([&](const auto& s) { shape(r, s, m); }, m.workspace.shape);
  return r;
}

std::vector<ValidationPoint> workspace_points(const Mechanism& m) {
  const Region r = region_of(m);
  std::vector<ValidationPoint> points;
  const auto add = [&](const Vector6& at) { points.push_back({std::to_string(points.size()), at}); };
  const auto add_beside = [&](const Vector3& shift) {
    Vector6 at = r.centre_mm_deg;
    at.head<3>() += shift;
    add(at);
  };
  for (const Vector6& at : r.poses_mm_deg) add(at);
  if (!points.empty()) return points;
  if (r.holds(r.centre_mm_deg.head<3>())) add(r.centre_mm_deg);
  const Vector3 extent = r.high_mm - r.low_mm;
  if (r.radius_mm) {
    const bool flat = extent.z() == 0;
    for (const double z : flat ? std::vector{0.0} : std::vector{extent.z() / 2, -extent.z() / 2})
      for (int i = 0; i < (flat ? 8 : 4); ++i) {
        const double angle = 2 * pi * i / (flat ? 8 : 4);
        add_beside({*r.radius_mm * std::cos(angle), *r.radius_mm * std::sin(angle), z});
      }
  } else if (!r.corners_mm.empty()) {
    for (const Point2& corner : r.corners_mm)
      add_beside({corner.x() - r.centre_mm_deg(0), corner.y() - r.centre_mm_deg(1), 0});
  } else {
    for (const Vector3& sign : corner_signs(extent)) add_beside(sign.cwiseProduct(extent / 2));
  }
  return points;
}

Vector6 draw_pose(const Region& r, measurement::Random& random) {
  if (!r.poses_mm_deg.empty()) {
    const double i = random.uniform(0, static_cast<double>(r.poses_mm_deg.size()));
    return r.poses_mm_deg[std::min(static_cast<std::size_t>(i), r.poses_mm_deg.size() - 1)];
  }
  const Vector3 middle = (r.low_mm + r.high_mm) / 2, half = (r.high_mm - r.low_mm) / 2;
  for (;;) {
    const Vector3 p = middle + random.uniform3(-1, 1).cwiseProduct(half);
    if (!r.holds(p)) continue;
    Vector6 at = r.centre_mm_deg;
    at.head<3>() = p;
    return at;
  }
}

}  // namespace deflect::studies
