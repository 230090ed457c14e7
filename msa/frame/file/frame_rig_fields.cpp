// Fields of how a frame is loaded and read: sensors, recorded loads, tolerances.
#include <fmt/format.h>

#include <algorithm>

#include "msa/base/index.h"
#include "msa/fields/yaml_tree.h"
#include "msa/frame/file/frame_fields.h"
#include "msa/mechanism/rig_fields.h"

namespace deflect::frame {
namespace {

using Reads = FrameSensor::Reads;

constexpr const char* trusted_kinds[] = {"support", "load", "load cell", "sensor"};

/// What is common to all, and how far the sensor sticks.
void describe_reading(FieldVisitor& v, FrameSensor& s, Dimension d) {
  describe_errors(v, s, d);
  Quantity stick{d, not_negative, 0};
  stick.or_dimension = other_of(d);
  v.quantity("stick", s.stick, stick, "how far the reading lags before it follows");
  v.quantity("resolution", s.resolution, stick, "the step in which it reads");
  FrameEntries<double> shares(
      s.crosstalk,
      [](auto& w, auto&, auto& share) {
        w.quantity("", share, {Dimension::ratio, {}, std::nullopt}, "share of that sensor's reading");
      },
      true);
  v.entries("crosstalk", shares, Need::optional, "what it reads of other sensors of the same quantity, by their names");
}

std::size_t place_in(const std::array<const char*, 6>& names, const std::string& word) {
  return std::min<std::size_t>(5, as_size(std::find(names.begin(), names.end(), word) - names.begin()));
}

void describe_component(FieldVisitor& v, const char* key, const char* what, FrameSensor& s,
                        const std::array<const char*, 6>& names, const char* about) {
  std::string word = names.at(s.component);
  v.word(key, word, {what, {names.begin(), names.end()}, std::nullopt}, about);
  s.component = place_in(names, word);
}

void describe_position(FieldVisitor& v, double& at) {
  v.quantity("at", at, {Dimension::ratio, Range{0, 1}, 0.5}, "where along the member, as a share of its length");
}

void describe_node_sensor(FieldVisitor& v, FrameSensor& s, const FrameNames& names) {
  v.text("node", s.of, Need::required, "node whose displacement or rotation is read");
  require_known(v, "node", "node", s.of, names.nodes, names.frame.nodes);
  s.reads = Reads::displacement;
  describe_direction(v, s.direction, s.axis, s.rotation);
  describe_reading(v, s, s.rotation ? Dimension::angle : Dimension::length);
}

void describe_support_sensor(FieldVisitor& v, FrameSensor& s, const FrameNames& names) {
  v.text("support", s.of, Need::required, "supported node whose reaction is read");
  require_known(v, "support", "support at node", s.of, names.supports, names.frame.supports);
  s.reads = Reads::reaction;
  describe_component(v, "reaction", "component of a reaction", s, wrench_names,
                     "component of the reaction on the frame, base axes");
  describe_reading(v, s, s.component < 3 ? Dimension::force : Dimension::moment);
}

void describe_member_sensor(FieldVisitor& v, FrameSensor& s, const FrameNames& names) {
  v.text("member", s.of, Need::required, "member that carries the load cell or the strain gauge");
  require_known(v, "member", "member", s.of, names.members, names.frame.members);
  s.reads = v.alternative({"force", "strain"}, s.reads == Reads::strain ? 1 : 0) == 1 ? Reads::strain : Reads::force;
  if (s.reads == Reads::force) {
    describe_component(v, "force", "component of the forces in a section", s, section_force_names,
                       "axial (tension positive), Vy, Vz, T, My or Mz, member axes");
    describe_position(v, s.at);
    describe_reading(v, s, s.component < 3 ? Dimension::force : Dimension::moment);
    return;
  }
  const auto fibre = [&] {
    describe_position(v, s.at);
    v.quantity("y", s.y, {Dimension::length, {}, 0}, "of the fibre, from the centroid, member axes");
    v.quantity("z", s.z, {Dimension::length, {}, 0}, "of the fibre, from the centroid, member axes");
  };
  v.object("strain", Need::required, false, fibre, "where the strain is read");
  describe_reading(v, s, Dimension::strain);
}

/// Whether both read numbers of one unit.
bool reads_alike(const FrameSensor& a, const FrameSensor& b) {
  const auto kind = [](const FrameSensor& s) {
    if (s.reads == Reads::strain) return 0;
    if (s.reads == Reads::displacement) return s.rotation ? 1 : 2;
    return s.component < 3 ? 3 : 4;
  };
  return kind(a) == kind(b);
}

void describe_sensor(FieldVisitor& v, FrameSensor& s, const FrameNames& names) {
  const std::size_t now = s.reads == Reads::displacement ? 0 : s.reads == Reads::reaction ? 2 : 1;
  switch (v.alternative({"node", "member", "support"}, now)) {
    case 0:
      return describe_node_sensor(v, s, names);
    case 1:
      return describe_member_sensor(v, s, names);
    default:
      return describe_support_sensor(v, s, names);
  }
}

}  // namespace

void describe_rig(FieldVisitor& v, FrameDescription& f, const FrameNames& names) {
  FrameEntries<FrameSensor> sensors(f.sensors, [&](auto& w, auto&, auto& s) { describe_sensor(w, s, names); });
  v.entries("sensors", sensors, Need::optional, "what is read, by name");
  for (const auto& [name, sensor] : f.sensors)
    for (const auto& [other, share] : sensor.crosstalk) {
      const FrameSensor* source = find(f.sensors, other);
      v.require(source && other != name && reads_alike(*source, sensor), "sensors",
                fmt::format("{}: crosstalk is with another sensor of the same quantity, not with '{}'", name, other));
    }
  const auto cell = [&] {
    v.quantity("gain", f.load_gain, {Dimension::ratio, positive, 1}, "true load over recorded load");
  };
  const auto rig = [&] {
    v.object("load_cell", Need::optional, false, cell, "how loads are recorded");
    v.texts("trusted", f.trusted, Need::optional, "where nothing is missing: support, load, load cell, sensor");
    const std::vector<std::string> known{std::begin(trusted_kinds), std::end(trusted_kinds)};
    for (const std::string& kind : f.trusted)
      v.require(std::find(known.begin(), known.end(), kind) != known.end(), "trusted",
                fmt::format("there is no '{}' to trust{}", kind, suggestion(kind, known)));
  };
  v.object("rig", Need::optional, false, rig, "how loads are recorded");
  const auto tolerances = [&] {
    constexpr Range at_most_all{0, 1};
    v.quantity("modulus", f.tolerances.modulus, {Dimension::ratio, at_most_all, 0}, "of each material, relative");
    v.quantity("load", f.tolerances.load, {Dimension::ratio, at_most_all, 0}, "of a recorded load, relative");
    v.others(f.tolerances.numbers,
             "of single numbers: a kind of part and a field (member.bending_factor, node.position), or a path");
  };
  v.object("tolerances", Need::optional, false, tolerances, "standard deviations between frames built alike");
}

}  // namespace deflect::frame
