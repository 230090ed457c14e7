#include "validation/recording/other_quantities.h"

#include <fmt/format.h>

#include <algorithm>

#include "msa/base/index.h"
#include "validation/measurement/column_names.h"

namespace deflect::recording {
namespace {

using frame::FrameSensor;
using Reads = FrameSensor::Reads;

std::string words_of(const FrameSensor& s) {
  switch (s.reads) {
    case Reads::displacement:
      return fmt::format("{} of node {}", s.direction, s.of);
    case Reads::force:
      return fmt::format("{} of member {}", nth(frame::section_force_names, s.component), s.of);
    case Reads::strain:
      return fmt::format("the strain of member {} at {:g} of its length, y = {:g} mm, z = {:g} mm", s.of, s.at,
                         1e3 * s.y, 1e3 * s.z);
    case Reads::reaction:
      break;
  }
  return fmt::format("{} of support {}", nth(frame::wrench_names, s.component), s.of);
}

/// Whether a frame in this plane can move so.
bool moves(frame::Plane plane, Eigen::Index axis, bool rotation) {
  const int normal = frame::normal_axis(plane);
  return normal > 2 || (axis == normal) == rotation;
}

void add_displacements(const FrameSensor& own, const frame::FrameDescription& f, std::vector<FrameSensor>& out) {
  for (const auto& [node, position] : f.nodes)
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (!moves(f.plane, axis, own.rotation)) continue;
      FrameSensor other = own;
      other.of = node;
      other.direction = nth(frame::node_freedoms, own.rotation ? 3 + axis : axis);
      other.axis = Vector3::Unit(axis);
      if (node != own.of || other.axis != own.axis) out.push_back(std::move(other));
    }
}

/// Forces are one kind, moments another: the first three components and the others; of a reaction so, too. Of a section
/// they are N, Vy, Vz and T, My, Mz.
void add_components(const FrameSensor& own, std::vector<FrameSensor>& out) {
  const std::size_t first = own.component < 3 ? 0 : 3;
  for (std::size_t k = first; k < first + 3; ++k) {
    FrameSensor other = own;
    other.component = k;
    if (k != own.component) out.push_back(std::move(other));
  }
}

template <class T>
void add_parts(const FrameSensor& own, const Named<T>& parts, std::vector<FrameSensor>& out) {
  for (const auto& [name, part] : parts) {
    FrameSensor other = own;
    other.of = name;
    if (name != own.of) out.push_back(std::move(other));
  }
}

/// At the other end of the member, on the other side, on the side next to it.
void add_mirrored(const FrameSensor& own, std::vector<FrameSensor>& out) {
  for (const double at : {own.at, 1 - own.at})
    for (const auto& [y, z] : {std::pair{own.y, own.z}, {-own.y, -own.z}, {own.z, own.y}, {-own.z, -own.y}}) {
      FrameSensor other = own;
      other.at = at, other.y = y, other.z = z;
      if (at != own.at || y != own.y || z != own.z) out.push_back(std::move(other));
    }
}

std::vector<FrameSensor> others(const FrameSensor& own, const frame::FrameDescription& f) {
  std::vector<FrameSensor> out;
  switch (own.reads) {
    case Reads::displacement:
      add_displacements(own, f, out);
      break;
    case Reads::force:
      add_parts(own, f.members, out);
      add_components(own, out);
      break;
    case Reads::strain:
      add_parts(own, f.members, out);
      add_mirrored(own, out);
      break;
    case Reads::reaction:
      add_parts(own, f.supports, out);
      add_components(own, out);
  }
  return out;
}

}  // namespace

std::vector<OtherQuantity> other_quantities(const measurement::Measurements& m, const frame::FrameDescription& f,
                                            std::size_t sensor) {
  const measurement::SensorChannel& channel = m.instruments.sensors[sensor];
  const FrameSensor* own = find(f.sensors, channel.name);
  std::vector<OtherQuantity> out;
  if (!own) return out;
  for (FrameSensor& other : others(*own, f)) {
    OtherQuantity each{std::move(other), {}};
    const std::string words = words_of(each.shown);
    each.correction.id = fmt::format("{}_shows_{}", channel.name, words);
    each.correction.sentence = fmt::format(
        "{} with what {} would read, in place of {}: correct where the sensor is, or the name of the column",
        measurement::sensor_column(channel), words, words_of(*own));
    each.correction.description = [name = channel.name, shown = each.shown](frame::FrameDescription& built) {
      for (auto& [key, value] : built.sensors)
        if (key == name) value = shown;
    };
    out.push_back(std::move(each));
  }
  return out;
}

}  // namespace deflect::recording
