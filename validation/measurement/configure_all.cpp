#include "validation/measurement/configure_all.h"

#include <fmt/format.h>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/mechanism/inside.h"
#include "msa/mechanism/stand.h"
#include "validation/measurement/measurement_columns.h"

namespace deflect::measurement {
namespace {

void check_joints(const Mechanism& mechanism, const Measurements& m) {
  std::vector<std::string> wanted, given;
  for (const Actuator& actuator : actuators_of(mechanism))
    wanted.push_back(joint_column(wanted.size(), actuator.rotation));
  for (const bool rotates : m.joint_rotates) given.push_back(joint_column(given.size(), rotates));
  if (wanted != given)
    throw InputError(fmt::format("{}:1: joint coordinates {} are given, but {} has {}", m.origin,
                                 fmt::join(given, ", "), mechanism.name, fmt::join(wanted, ", ")));
}

}  // namespace

std::vector<Configuration> configure_all(const Mechanism& mechanism, const Measurements& m,
                                         std::span<const Configuration> known) {
  if (m.by_joints() && known.empty()) check_joints(mechanism, m);
  std::vector<Configuration> configurations;
  configurations.reserve(m.poses.size());
  for (const PoseGroup& group : m.poses) {
    const auto place = [&] {
      return fmt::format("{}:{}: column 'pose': '{}': ", m.origin, m.readings.at(group.readings.front()).line,
                         excerpt(group.label));
    };
    const std::size_t p = configurations.size();
    const Configuration* before = p < known.size() ? &known[p] : nullptr;
    configurations.push_back(told_at<ModelError>(place, [&] {
      return m.by_joints() ? configure_joints(mechanism, group.joints, before)
                           : configure(mechanism, pose_from(group.pose_mm_deg), before);
    }));
  }
  return configurations;
}

Quantity quantity_of(const PointSensor& s) {
  if (!s.drive.empty()) return s.rotation ? Quantity::moment : Quantity::force;
  return s.rotation ? Quantity::angle : Quantity::length;
}

SensorPlace sensor_place(const Mechanism& mechanism, const PointSensor& s, const Configuration& c) {
  const std::optional<NamedPart> part = inside_part(mechanism, s);
  const std::string body = part ? s.body : "the " + s.body;
  const std::string what = !s.drive.empty() ? fmt::format("{} of {}", s.rotation ? "moment" : "force", s.drive)
                                            : fmt::format("{} on {}", s.rotation ? "rotation sensor" : "sensor", body);
  if (!part) return {c.pose.p_WT + c.pose.R_WT * s.point, s.axis, what};
  const PartEnd end = end_of(placed(*part, c), c);
  if (part->freedom) return {end.p_W, end.R_W.col(as_index(*part->freedom % 3)), what};
  return {end.p_W + end.R_W * s.point, s.axis, what};
}

Instruments instruments_of(const Mechanism& mechanism) {
  Instruments out;
  for (const auto& [name, s] : mechanism.sensors)
    out.sensors.push_back({name, quantity_of(s), s.sigma > 0 ? std::optional(s.sigma) : std::nullopt});
  for (const auto& [name, point] : mechanism.loads) out.load_points.push_back(name);
  return out;
}

Measurements place_loads(Measurements m, const Mechanism& mechanism) {
  if (m.instruments.load_points.empty()) return m;
  std::vector<const LoadPoint*> points;
  for (const std::string& name : m.instruments.load_points)
    for (const auto& [known, point] : mechanism.loads)
      if (known == name) points.push_back(&point);
  const std::vector<Configuration> machines = configure_all(mechanism, m);
  for (Reading& r : m.readings) {
    r.load = r.at_tool;
    r.on_platform.setZero();
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Vector3 arm = machines[r.pose].pose.R_WT * points[k]->point;
      const Vector6 at_T = shift_twist(arm).transpose() * r.at_points[k];
      r.load += at_T;
      if (points[k]->body == "platform") r.on_platform += at_T;
    }
  }
  return m;
}

}  // namespace deflect::measurement
