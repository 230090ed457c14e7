#include "validation/subject/frame_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>

#include "msa/base/index.h"
#include "msa/frame/file/frame_file.h"
#include "validation/subject/frame_readings.h"
#include "validation/subject/place_groups.h"

namespace deflect::subject {
namespace {

using frame::FrameDescription;

constexpr double on_a_line = 1e-6;  // of the frame's size

std::string name_in(const Place& p) { return p.path.substr(p.path.find('.') + 1); }

/// A place that holds a node, and where that is.
struct Held {
  Place place;
  Vector3 p_W;
  bool to_ground = true;
};

/// On one line along an axis: the other two coordinates are the same.
void add_lines(std::vector<Held> held, const char* id, const char* words, double size, Groups& out) {
  std::erase_if(held, [](const Held& h) { return !h.to_ground; });
  std::vector<Place> places;
  for (const Held& h : held) places.push_back(h.place);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<bool> taken(held.size(), false);
    for (std::size_t i = 0; i < held.size(); ++i) {
      if (taken[i]) continue;
      std::vector<Place> line;
      for (std::size_t k = i; k < held.size(); ++k) {
        Vector3 apart = held[k].p_W - held[i].p_W;
        apart(axis) = 0;
        if (taken[k] || apart.norm() > on_a_line * size || held_as(held[k].place) != held_as(held[i].place)) continue;
        taken[k] = true;
        line.push_back(held[k].place);
      }
      const std::string first = name_in(line.front());
      const char along = "xyz"[axis];
      out.add(line, fmt::format("{}.{}.along_{}", id, first, along),
              fmt::format("{} on the line through {} along {}", words, first, along));
    }
  }
}

void add_held(const std::vector<Held>& held, const char* id, const char* words, double size, Groups& out) {
  std::vector<Place> places;
  for (const Held& h : held) places.push_back(h.place);
  for (const auto& part : parted(places, held_as)) out.add(part, id, words);
  add_lines(held, id, words, size, out);
}

/// Ends that turn in the same way: in a plane frame all of them do, whatever axis of the member that is.
void add_ends(const FrameDescription& f, const std::vector<Place>& ends, Groups& out) {
  const auto held = [&](const Place& p) {
    return f.plane == frame::Plane::none ? held_as(p) : fmt::format("{} {}", fmt::underlying(p.hold), p.one_stiffness);
  };
  for (const auto& part : parted(ends, held)) {
    for (const auto& same : parted(part, [](const Place& p) { return p.make; }))
      out.add(same, "ends." + same.front().make, "ends of members of section " + same.front().make);
    out.add(part, "ends", "ends of members");
  }
}

void add_members(const std::vector<Place>& members, Groups& out) {
  const auto listed = [&](const std::vector<Place>& part, const std::string& id, const std::string& words) {
    const std::size_t before = out.all.size();
    out.add(part, id, words);
    if (out.all.size() > before) out.all.back().whole_section = true;
  };
  for (const auto& part : parted(members, [](const Place& p) { return p.make; }))
    listed(part, "members." + part.front().make, "members of section " + part.front().make);
  listed(members, "members", "members");
}

}  // namespace

std::vector<Place> groups_of(const FrameDescription& f, const std::vector<Place>& places) {
  std::vector<Held> supports, springs;
  std::vector<Place> ends, members;
  for (const Place& p : places) {
    if (p.kind == PlaceKind::support) {
      supports.push_back({p, *find(f.nodes, name_in(p))});
    } else if (p.path.starts_with("springs.")) {
      const frame::FrameSpring& spring = *find(f.springs, name_in(p));
      springs.push_back({p, *find(f.nodes, spring.node), spring.to.empty()});
    } else if (p.kind == PlaceKind::member_end) {
      ends.push_back(p);
    } else if (p.path.starts_with("members.")) {
      members.push_back(p);
    }
  }
  Groups out(places);
  const double size = size_of(f);
  add_held(supports, "supports", "supports", size, out);
  add_held(springs, "springs", "springs", size, out);
  add_ends(f, ends, out);
  add_members(members, out);
  return std::move(out.all);
}

}  // namespace deflect::subject
