#include "validation/subject/frame_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/frame/file/frame_file.h"
#include "msa/frame/file/member_axes.h"
#include "validation/subject/frame_readings.h"

namespace deflect::subject {
namespace {

using frame::FrameDescription;

/// How laws, where there are any, hold a freedom.
void set_hold(Place& p, const frame::FreedomLaws& laws, std::size_t freedom, bool rigid) {
  p.hold = laws.has(freedom) ? Hold::elastic : rigid ? Hold::rigid : Hold::free;
  const std::vector<Law> all = laws.at(freedom);
  p.one_stiffness = all.size() == 1 && std::holds_alternative<LinearLaw>(all.front());
}

void add_supports(const FrameDescription& f, std::vector<Place>& out) {
  for (const auto& [node, support] : f.supports)
    for (std::size_t i = 0; i < 6; ++i) {
      if (out_of_plane(f, i)) continue;
      Place p{PlaceKind::support, {}, "support." + node, "supports." + node, {i}};
      set_hold(p, support.laws, i, support[i]);
      p.base_axes = true;
      out.push_back(std::move(p));
    }
}

void add_springs(const FrameDescription& f, std::vector<Place>& out) {
  for (const auto& [name, spring] : f.springs)
    for (std::size_t i = 0; i < 6; ++i) {
      if (!spring.acting()[i] || spring.coupled || out_of_plane(f, i)) continue;
      Place p{PlaceKind::joint, {}, "spring." + name, "springs." + name, {i}};
      set_hold(p, spring.laws, i, false);
      if (spring.stiffness[i]) p.hold = Hold::elastic, p.one_stiffness = true;
      p.base_axes = true;
      out.push_back(std::move(p));
    }
}

/// Whether a turn about the member's local y (4) or z (5) stays in the plane.
bool bends_in_plane(const FrameDescription& f, const frame::FrameMember& m, std::size_t freedom) {
  const Vector3 along = *find(f.nodes, m.to) - *find(f.nodes, m.from);
  const Vector3 axis = frame::member_axes(along, m.y_axis).col(as_index(freedom) - 3);
  return std::abs(axis(frame::normal_axis(f.plane))) > 0.5;
}

/// A member's ends bend about y and z; in a plane frame, whose members lie in it, about one of them.
void add_members(const FrameDescription& f, std::vector<Place>& out) {
  const bool bends = f.geometry != Geometry::linear || !has_linear_laws(f);
  for (const auto& [name, member] : f.members) {
    out.push_back({PlaceKind::member, {}, name, "members." + name});
    const frame::FrameMaterial* material = find(f.materials, member.material);
    out.back().expands = material && material->expansion;
    out.back().misfit_shows = bends;
    out.back().make = member.section;
    if (member.truss) continue;
    for (const char* end : {"start", "end"}) {
      const frame::Freedoms& released = end[0] == 's' ? member.release_from : member.release_to;
      const frame::FreedomLaws& laws = end[0] == 's' ? member.start : member.end;
      Place p{PlaceKind::member_end, {}, fmt::format("{}.{}", name, end), fmt::format("members.{}.{}", name, end)};
      p.make = member.section;
      const auto add = [&](std::vector<std::size_t> freedoms) {
        set_hold(p, laws, freedoms.front(), !released[freedoms.front()]);
        p.freedoms = std::move(freedoms);
        out.push_back(p);
      };
      if (f.plane == frame::Plane::none && released[4] == released[5] && !released[4] && !laws.has(4) && !laws.has(5)) {
        add({4, 5});
        continue;
      }
      for (const std::size_t i : {std::size_t{4}, std::size_t{5}})
        if (f.plane == frame::Plane::none || bends_in_plane(f, member, i)) add({i});
    }
  }
}

/// Every length of every section; every material where there are several.
void add_stock(const FrameDescription& f, std::vector<Place>& out) {
  if (f.materials.size() > 1)
    for (const auto& [name, material] : f.materials)
      out.push_back({PlaceKind::member, {}, "materials." + name, "materials." + name});
  for (const DescribedNumber& n : frame::described_numbers(f))
    if (n.path.starts_with("sections.") && n.dimension == Dimension::length && n.value != 0)
      out.push_back({PlaceKind::member, {}, n.path, n.path});
}

}  // namespace

bool out_of_plane(const FrameDescription& f, std::size_t freedom) {
  return f.plane != frame::Plane::none && (as_index(freedom % 3) == frame::normal_axis(f.plane)) == (freedom < 3);
}

measurement::Quantity quantity_of(const frame::FrameSensor& s) {
  using Reads = frame::FrameSensor::Reads;
  using measurement::Quantity;
  if (s.reads == Reads::strain) return Quantity::strain;
  if (s.reads == Reads::displacement) return s.rotation ? Quantity::angle : Quantity::length;
  return s.component < 3 ? Quantity::force : Quantity::moment;
}

std::vector<Place> places_of(const FrameDescription& f) {
  std::vector<Place> out;
  add_supports(f, out);
  add_springs(f, out);
  add_members(f, out);
  add_stock(f, out);
  for (const auto& [name, load] : f.loads) {
    out.push_back({PlaceKind::load, {}, name, "loads." + name});
    const auto in_base = [](const auto& line) { return !line.second.member_axes; };
    if (!load.nodes.empty() || !load.gravity.isZero(0) ||
        std::any_of(load.members.begin(), load.members.end(), in_base))
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (f.plane == frame::Plane::none || as_index(axis) == frame::normal_axis(f.plane))
          out.back().turns.push_back(axis);
  }
  for (const auto& [name, sensor] : f.sensors) {
    out.push_back({PlaceKind::sensor, {}, name, "sensors." + name});
    out.back().may_stick = true;
    if (!sensor.free_zero) out.back().reads = quantity_of(sensor);
    for (const auto& [other, source] : f.sensors)
      if (other != name && quantity_of(source) == quantity_of(sensor) && !find(sensor.crosstalk, other)) {
        out.push_back({PlaceKind::sensor, {}, name + "." + other, "sensors." + name + ".crosstalk"});
        out.back().other = other;
      }
  }
  std::erase_if(out, [&](const Place& p) {
    return std::find(f.trusted.begin(), f.trusted.end(), nth(place_kind_names, p.kind)) != f.trusted.end();
  });
  return out;
}

}  // namespace deflect::subject
