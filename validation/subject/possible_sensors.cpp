#include "validation/subject/possible_sensors.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <variant>

#include "msa/base/index.h"
#include "msa/frame/file/frame_description.h"
#include "msa/mechanism/description.h"

namespace deflect::subject {
namespace {

using frame::FrameDescription;
using frame::FrameSensor;
using measurement::Quantity;

constexpr const char* motions[] = {"ux", "uy", "uz", "rx", "ry", "rz"};

constexpr const char* tool_point = "tool_point";

/// Each with what it is in a description.
template <class Sensor>
using Listed = std::vector<std::pair<PossibleSensor, Sensor>>;

template <class Sensor>
Sensor of_motion(std::size_t i) {
  Sensor out;
  out.direction = motions[i];
  out.axis = Vector3::Unit(as_index(i % 3));
  out.rotation = i >= 3;
  return out;
}

std::string name_of(std::size_t motion, const std::string& body) {
  return fmt::format("{}_of_{}", motions[motion], body);
}

Quantity quantity_of(std::size_t motion) { return motion < 3 ? Quantity::length : Quantity::angle; }

/// The parts of a leg. Into branches in parallel nobody looks.
const Named<Part>& parts_of(const Mechanism& m, std::size_t leg) {
  return leg < m.mounts.size() && !m.mounts[leg].leg.empty() ? m.mounts[leg].leg : m.leg;
}

Listed<PointSensor> listed(const Mechanism& m, int legs) {
  Listed<PointSensor> out;
  const auto add = [&](const std::string& name, const std::string& body, std::size_t i) {
    PointSensor sensor = of_motion<PointSensor>(i);
    sensor.body = body;
    const auto reads_it = [&](const auto& s) {
      return s.second.drive.empty() && s.second.body == body && s.second.direction == sensor.direction &&
             s.second.point.isZero(0);
    };
    if (std::any_of(m.sensors.begin(), m.sensors.end(), reads_it)) return;
    out.push_back(
        {{name_of(i, name), fmt::format("body: {}, direction: {}", body, motions[i]), quantity_of(i)}, sensor});
  };
  for (std::size_t i = 0; i < 6; ++i) add(tool_point, "tool", i);
  for (std::size_t leg = 0; leg < as_size(legs); ++leg)
    for (const auto& [name, part] : parts_of(m, leg))
      for (std::size_t i = 0; i < 3 && (std::holds_alternative<Joint>(part) || std::holds_alternative<Member>(part));
           ++i)
        add(fmt::format("{}_in_leg_{}", name, leg + 1), fmt::format("leg.{}.{}", leg + 1, name), i);
  return out;
}

/// By quantity; 0 where no sensor has any.
struct Noise {
  double length = 0, angle = 0, force = 0;
};

Noise least_noise(const FrameDescription& f) {
  Noise out;
  for (const auto& [name, s] : f.sensors) {
    const bool axial = s.reads == FrameSensor::Reads::force && s.component < 3;
    if (!(s.sigma > 0) || !(axial || s.reads == FrameSensor::Reads::displacement)) continue;
    double& least = axial ? out.force : s.rotation ? out.angle : out.length;
    least = least > 0 ? std::min(least, s.sigma) : s.sigma;
  }
  Vector3 low = f.nodes.front().second, high = low;
  for (const auto& [name, at] : f.nodes) low = low.cwiseMin(at), high = high.cwiseMax(at);
  if (!(out.angle > 0)) out.angle = out.length / (0.1 * (high - low).norm());
  return out;
}

Listed<FrameSensor> listed(const FrameDescription& f) {
  Listed<FrameSensor> out;
  const Noise noise = least_noise(f);
  const auto add = [&](PossibleSensor p, FrameSensor sensor) {
    const auto reads_it = [&](const auto& s) {
      return s.second.reads == sensor.reads && s.second.of == sensor.of && s.second.direction == sensor.direction &&
             s.second.component == sensor.component;
    };
    if (std::any_of(f.sensors.begin(), f.sensors.end(), reads_it)) return;
    sensor.sigma = p.sigma;
    out.emplace_back(std::move(p), std::move(sensor));
  };
  const int normal = frame::normal_axis(f.plane);
  for (const auto& [node, at] : f.nodes)
    for (std::size_t i = 0; i < 6; ++i) {
      if (normal < 3 && (i >= 3) != (as_index(i % 3) == normal)) continue;  // a plane has two translations, a rotation
      FrameSensor sensor = of_motion<FrameSensor>(i);
      sensor.of = node;
      add({fmt::format("{} of node {}", motions[i], node), fmt::format("node: {}, direction: {}", node, motions[i]),
           quantity_of(i), i < 3 ? noise.length : noise.angle},
          std::move(sensor));
    }
  for (const auto& [name, member] : f.members) {
    FrameSensor sensor;
    sensor.reads = FrameSensor::Reads::force;
    sensor.of = name;
    add({fmt::format("axial force of {}", name), fmt::format("member: {}, force: axial", name), Quantity::force,
         noise.force},
        std::move(sensor));
  }
  return out;
}

template <class Description, class Sensor>
Subject with(Description d, const Listed<Sensor>& listed, const std::vector<PossibleSensor>& wanted) {
  for (const PossibleSensor& p : wanted) {
    const auto at = std::find_if(listed.begin(), listed.end(), [&](const auto& l) { return l.first.name == p.name; });
    if (at == listed.end()) throw std::logic_error(fmt::format("there is no possible sensor '{}'", p.name));
    d.sensors.emplace_back(p.name, at->second);
    d.sensors.back().second.sigma = p.sigma;
  }
  return d;
}

template <class Sensor>
std::vector<PossibleSensor> names_of(const Listed<Sensor>& all) {
  std::vector<PossibleSensor> out;
  for (const auto& [possible, sensor] : all) out.push_back(possible);
  return out;
}

}  // namespace

std::string name_at_tool_point(std::size_t component) { return name_of(component, tool_point); }

std::vector<PossibleSensor> possible_sensors(const Subject& s) {
  return s.frame() ? names_of(listed(*s.frame())) : names_of(listed(*s.machine(), s.legs()));
}

Subject with_sensors(const Subject& s, const std::vector<PossibleSensor>& wanted) {
  return s.frame() ? with(*s.frame(), listed(*s.frame()), wanted)
                   : with(*s.machine(), listed(*s.machine(), s.legs()), wanted);
}

}  // namespace deflect::subject
