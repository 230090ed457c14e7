#include "validation/subject/machine_places.h"

#include <fmt/format.h>

#include <algorithm>

#include "msa/base/index.h"
#include "msa/fields/yaml_tree.h"
#include "msa/mechanism/joint_table.h"
#include "msa/mechanism/law.h"
#include "msa/mechanism/mechanism_tree.h"
#include "msa/mechanism/place.h"
#include "validation/measurement/configure_all.h"
#include "validation/subject/part_roles.h"

namespace deflect::subject {
namespace {

class Places {
 public:
  std::vector<Place> all;

  void chain(const Named<Part>& parts, const std::string& path, const std::string& nested) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const auto& [name, part] = parts[i];
      const std::string here = joined(path, name), id = joined(nested, name);
      const Part* before = i > 0 ? &parts[i - 1].second : nullptr;
      const Part* after = i + 1 < parts.size() ? &parts[i + 1].second : nullptr;
      if (const auto* joint = std::get_if<Joint>(&part)) {
        of_joint(*joint, here, id, after && std::holds_alternative<Member>(*after));
      } else if (std::holds_alternative<Member>(part)) {
        const std::size_t first = all.size();
        all.push_back({PlaceKind::member, {}, id, here});
        if (!before || !std::holds_alternative<Joint>(*before)) end(PlaceKind::clamp, here + ".start", id + ".start");
        if (!after || !std::holds_alternative<Joint>(*after)) end(PlaceKind::member_end, here + ".end", id + ".end");
        if (is_bar(parts, i)) all.push_back({PlaceKind::line, {}, id + ".start", here + ".start", {0}});
        for (std::size_t k = first; k < all.size(); ++k) all[k].make = std::get<Member>(part).section;
      } else if (const auto* group = std::get_if<Parallel>(&part)) {
        branches(*group, here, id);
      }
    }
  }

  void branches(const Parallel& group, const std::string& path, const std::string& nested) {
    chain(group.leg, path + ".leg", nested);
    for (std::size_t i = 0; i < group.mounts.size(); ++i)
      chain(group.mounts[i].leg, fmt::format("{}.mounts.{}.leg", path, i), fmt::format("{}.mounts.{}", nested, i));
  }

  void of_joint(const Joint& joint, const std::string& path, const std::string& id, bool holds_member) {
    if (joint.stiffness) return;
    const std::array<Freedom, 6> freedoms = freedoms_of(joint);
    const bool slides = std::find(freedoms.begin(), freedoms.begin() + 3, Freedom::actuated) != freedoms.begin() + 3;
    std::array<Place, 6> each;
    for (std::size_t i = 0; i < 6; ++i) {
      const bool elastic = !joint.laws[i].empty();
      Place& p = each[i];
      p = {PlaceKind::joint, {}, id, path, {i}};
      p.hold = elastic ? Hold::elastic : freedoms[i] == Freedom::free ? Hold::free : Hold::rigid;
      p.one_stiffness = joint.laws[i].size() == 1 && std::holds_alternative<LinearLaw>(joint.laws[i].front());
      p.slides = slides;
      p.make = joint.type;
      if (!joint.at.empty()) p.axes = joint.axes;
      if (freedoms[i] == Freedom::actuated)
        p.kind = PlaceKind::drive;
      else if (freedoms[i] == Freedom::rigid && holds_member)
        p.kind = PlaceKind::clamp;
      all.push_back(p);
    }
    pair(each[0], each[1]);
    pair(each[3], each[4]);
  }

  /// Where a part is held rigidly in all its freedoms.
  void end(PlaceKind kind, const std::string& path, const std::string& id) {
    std::array<Place, 6> each;
    for (std::size_t i = 0; i < 6; ++i) {
      each[i] = {kind, {}, id, path, {i}};
      all.push_back(each[i]);
    }
    // x runs along the member: it bends about y and z.
    all.push_back({kind, {}, id, path, {4, 5}});
  }

 private:
  void pair(const Place& a, const Place& b) {
    if (a.hold == Hold::free || a.hold != b.hold || a.one_stiffness != b.one_stiffness || a.kind != b.kind) return;
    Place both = a;
    both.freedoms.push_back(b.freedoms.front());
    all.push_back(std::move(both));
  }
};

/// Every length of every section; every material where there are several.
void add_stock(const Mechanism& m, std::vector<Place>& out) {
  if (m.materials.size() > 1)
    for (const auto& [name, material] : m.materials)
      out.push_back({PlaceKind::member, {}, "materials." + name, "materials." + name});
  const YamlNode tree = tree_of(m);
  const YamlNode* sections = tree.child("sections");
  for (std::size_t i = 0; sections && i < sections->children.size(); ++i) {
    const YamlNode& section = sections->children[i];
    for (std::size_t k = 0; k < section.children.size(); ++k)
      if (section.children[k].dimension == Dimension::length && !section.children[k].implied) {
        const std::string path = fmt::format("sections.{}.{}", sections->keys[i], section.keys[k]);
        out.push_back({PlaceKind::member, {}, path, path});
      }
  }
}

/// Where loads act, and where the displacement of T is measured.
void add_points(const Mechanism& m, std::vector<Place>& out) {
  const auto add = [&](PlaceKind kind, const std::string& part, const std::string& path) {
    out.push_back({kind, {}, part, path});
    out.back().shifts = {0, 1, 2};
  };
  add(PlaceKind::load, "load", "rig.load_cell");
  add(PlaceKind::sensor, "sensor", "rig.sensor");
  for (const auto& [name, point] : m.loads) add(PlaceKind::load, "loads." + name, "loads." + name);
}

}  // namespace

std::vector<Place> places_of(const Mechanism& m) {
  Places found;
  found.chain(m.leg, "leg", "");
  for (std::size_t i = 0; i < m.mounts.size(); ++i)
    found.chain(m.mounts[i].leg, fmt::format("mounts.{}.leg", i), fmt::format("mounts.{}", i));
  // Named places have axes along every part: a bar's line is a direction of its joints.
  if (std::holds_alternative<SixPsu>(m.kinematics))
    std::erase_if(found.all, [](const Place& p) { return p.kind == PlaceKind::line; });
  add_stock(m, found.all);
  const std::size_t fixtures = found.all.size();
  found.of_joint(m.base, "base", "base", false);
  const std::size_t tool = found.all.size();
  found.of_joint(m.tool, "tool", "tool", false);
  for (std::size_t i = fixtures; i < found.all.size(); ++i)
    found.all[i].kind = i < tool ? PlaceKind::base : PlaceKind::tool;
  for (const auto& [name, sensor] : m.sensors) {
    found.all.push_back({PlaceKind::sensor, {}, name, "sensors." + name});
    if (!sensor.free_zero) found.all.back().reads = measurement::quantity_of(sensor);
  }
  add_points(m, found.all);
  std::erase_if(found.all, [&](const Place& p) {
    return std::find(m.trusted.begin(), m.trusted.end(), nth(place_kind_names, p.kind)) != m.trusted.end();
  });
  return std::move(found.all);
}

}  // namespace deflect::subject
