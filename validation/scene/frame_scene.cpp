#include "validation/scene/frame_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "msa/base/index.h"
#include "msa/frame/file/frame_file.h"
#include "msa/frame/file/member_axes.h"
#include "validation/figures/drawing.h"
#include "validation/report/text.h"
#include "validation/scene/scene_numbers.h"

namespace deflect::scene {
namespace {

using frame::CaseResult;
using frame::FrameDescription;
using frame::FrameResult;

constexpr std::size_t few_members = 250;
constexpr int drawn_elements = 8;

/// The same frame in more elements: exact at every node where it is linear.
std::optional<FrameResult> in_more_elements(const FrameDescription& f, const FrameResult& r) {
  if (r.geometry != Geometry::linear || f.members.size() > few_members) return {};
  frame::FrameOptions options;
  for (const auto& [name, member] : f.members) {
    const int n = std::max(drawn_elements, member.elements);
    std::vector<double> at;
    for (int i = 0; i <= n; ++i) at.push_back(static_cast<double>(i) / n);
    options.division.push_back(std::move(at));
  }
  return frame::analyse(f, options);
}

bool is_among(const std::string& name, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

Vector3 place_of(const FrameDescription& f, const FrameResult& r, const std::string& node) {
  return nth(f.nodes, r.structure.nodes.find(node)).second;
}

void put_members(Json& scene, Json& pose, const FrameDescription& f, const FrameResult& r,
                 const std::vector<std::string>& guilty) {
  for (std::size_t i = 0; i < f.members.size(); ++i) {
    const auto& [name, member] = f.members[i];
    const Section* section = find(f.sections, member.section);
    Json body = {{"leg", ""}, {"part", name}, {"kind", "member"}, {"guilty", is_among("member " + name, guilty)}};
    if (section) put_outline(body, figures::outline_of(*section), properties(*section, 0.3));
    scene["bodies"].push_back(std::move(body));
    const Vector3 along = place_of(f, r, member.to) - place_of(f, r, member.from);
    const Vector3 y = frame::member_axes(along, member.y_axis).col(1);
    pose["axes"].push_back({scene_digits(y.x()), scene_digits(y.y()), scene_digits(y.z())});
    for (int e = r.structure.first_element[i]; e < r.structure.first_element[i + 1]; ++e) {
      const frame::Beam& beam = nth(r.structure.model.beams, e);
      scene["cells"].push_back({beam.a, beam.b, i});
    }
  }
  if (r.structure.arms.empty()) return;
  for (const auto& [a, b] : r.structure.arms) scene["cells"].push_back({a, b, f.members.size()});
  scene["bodies"].push_back({{"leg", ""}, {"part", "rigid"}, {"kind", "offset"}, {"guilty", false}});
  pose["axes"].push_back(nullptr);
}

/// "ux uz"
std::string acting_words(const frame::Freedoms& acting) {
  std::string words;
  for (std::size_t i = 0; i < 6; ++i)
    if (acting[i]) words += std::string(words.empty() ? "" : " ") + frame::node_freedoms[i];
  return words;
}

/// Under each node that a support or a spring holds against the ground.
Json supports_of(const FrameDescription& f, const FrameResult& r, const std::vector<std::string>& guilty) {
  Json out = Json::array();
  for (const auto& [node, held] : f.supports) {
    const std::string words = acting_words(held);
    if (!words.empty())
      out.push_back({{"at_mm", scene_position(place_of(f, r, node))},
                     {"words", fmt::format("{}: {} held", node, words)},
                     {"name", "support " + node},
                     {"guilty", is_among("support " + node, guilty)},
                     {"whole", std::count(held.begin(), held.end(), true) == 6}});
  }
  for (const auto& [name, spring] : f.springs)
    if (spring.to.empty())
      out.push_back({{"at_mm", scene_position(place_of(f, r, spring.node))},
                     {"words", fmt::format("{}: {} on a spring", spring.node, acting_words(spring.acting()))},
                     {"name", "spring " + name},
                     {"point", r.structure.nodes.find(spring.node)},
                     {"guilty", is_among("spring " + name, guilty)},
                     {"whole", false}});
  return out;
}

/// Springs between two nodes, as joints.
Json springs_between(const FrameDescription& f, const FrameResult& r, const std::vector<std::string>& guilty) {
  Json out = Json::array();
  for (const auto& [name, spring] : f.springs)
    if (!spring.to.empty())
      out.push_back({{"point", r.structure.nodes.find(spring.node)},
                     {"leg", ""},
                     {"part", "spring " + name},
                     {"driven", false},
                     {"guilty", is_among("spring " + name, guilty)}});
  return out;
}

/// By name the point of each node.
Json nodes_of(const FrameDescription& f, const FrameResult& r) {
  Json out = Json::object();
  for (const auto& [name, position] : f.nodes) out[name] = r.structure.nodes.find(name);
  return out;
}

/// Along the member at the nodes of its elements; the value stands at one of them.
void put_line_load(Json& arrows, const FrameDescription& f, const FrameResult& r, const std::string& name,
                   const frame::LineLoad& load) {
  const auto i = as_size(r.structure.members.find(name));
  const frame::FrameMember& member = f.members[i].second;
  const Vector3 along = place_of(f, r, member.to) - place_of(f, r, member.from);
  const Vector3 q = load.member_axes ? Vector3(frame::member_axes(along, member.y_axis) * load.q) : load.q;
  if (q.norm() == 0) return;
  const int first = r.structure.first_element[i], last = r.structure.first_element[i + 1];
  for (int e = first; e < last; ++e) {
    const frame::Beam& beam = nth(r.structure.model.beams, e);
    const bool middle = e == first + (last - first) / 2;
    arrows.push_back({{"point", beam.a},
                      {"kind", "line"},
                      {"vector", {scene_digits(q.x()), scene_digits(q.y()), scene_digits(q.z())}},
                      {"words", middle ? fmt::format("{:.4g} N/mm", q.norm() / report::mm) : ""}});
  }
}

/// What is no arrow: "gravity (0, 0, −9.81) m/s²; 3 members warmer or colder; 1 support moved".
std::string other_loads(const frame::LoadCase& load) {
  std::string out;
  const auto add = [&](const std::string& words) { out += (out.empty() ? "" : "; ") + words; };
  const Vector3& g = load.gravity;
  if (g.norm() > 0) add(fmt::format("gravity ({:g}, {:g}, {:g}) m/s²", g.x(), g.y(), g.z()));
  if (!load.temperature.empty())
    add(fmt::format("{} member{} warmer or colder", load.temperature.size(), load.temperature.size() == 1 ? "" : "s"));
  if (!load.displacements.empty())
    add(fmt::format("{} support{} moved", load.displacements.size(), load.displacements.size() == 1 ? "" : "s"));
  return report::with_minus(out);
}

Json shape_of(const FrameDescription& f, const FrameResult& r, const CaseResult& c) {
  Json shape = {{"name", c.name}, {"arrows", Json::array()}, {"displacement_mm", Json::array()}};
  for (std::size_t i = 0; i < r.structure.model.nodes.size(); ++i)
    shape["displacement_mm"].push_back(scene_displacement(c.u.segment<3>(as_index(6 * i))));
  if (const frame::LoadCase* load = find(f.loads, c.name)) {
    for (const auto& [node, wrench] : load->nodes)
      put_load_arrows(shape["arrows"], r.structure.nodes.find(node), wrench);
    for (const auto& [member, line] : load->members) put_line_load(shape["arrows"], f, r, member, line);
    shape["other_loads"] = other_loads(*load);
  }
  return shape;
}

/// Where an entry differs, as the file has it.
std::vector<std::string> changed_entries(const YamlNode& before, const YamlNode& after, const char* list) {
  std::vector<std::string> out;
  const YamlNode *a = before.child(list), *b = after.child(list);
  for (std::size_t i = 0; b && i < b->children.size(); ++i) {
    const YamlNode* old = a ? a->child(b->keys[i]) : nullptr;
    if (!old || flow_yaml(*old) != flow_yaml(b->children[i])) out.push_back(b->keys[i]);
  }
  return out;
}

/// "start of beam" where only the start of this member differs; nothing where more of it does.
std::string changed_end(const YamlNode& before, const YamlNode& after, const std::string& member) {
  const YamlNode *a = before.child("members"), *b = after.child("members");
  const YamlNode *old = a ? a->child(member) : nullptr, *now = b ? b->child(member) : nullptr;
  if (!old || !now) return "";
  std::vector<std::string> keys = old->keys;
  for (const std::string& key : now->keys)
    if (!is_among(key, keys)) keys.push_back(key);
  std::erase_if(keys, [&](const std::string& key) {
    const YamlNode *x = old->child(key), *y = now->child(key);
    return x && y && flow_yaml(*x) == flow_yaml(*y);
  });
  return keys.size() == 1 && (keys[0] == "start" || keys[0] == "end") ? fmt::format("{} of {}", keys[0], member) : "";
}

Vector3 between(const Vector3& a, const Vector3& b, double share) { return a + share * (b - a); }

/// Where each sensor is, what it reads and along which direction.
Json sensors_of(const FrameDescription& f, const std::vector<std::string>& guilty) {
  using Reads = frame::FrameSensor::Reads;
  Json out = Json::array();
  for (const auto& [name, s] : f.sensors) {
    Vector3 at = Vector3::Zero(), axis = s.axis;
    std::string words = fmt::format("{}: {} of {}", name, s.direction, s.of);
    if (const frame::FrameMember* member = find(f.members, s.of); member && s.reads != Reads::displacement) {
      const Vector3 from = *find(f.nodes, member->from), to = *find(f.nodes, member->to);
      at = between(from, to, s.at);
      axis = (to - from).normalized();
      words = s.reads == Reads::strain
                  ? fmt::format("{}: strain of {}", name, s.of)
                  : fmt::format("{}: {} force in {}", name, frame::section_force_names[s.component], s.of);
    } else if (const Vector3* node = find(f.nodes, s.of)) {
      at = *node;
      if (s.reads == Reads::reaction) {
        axis = Vector3::Unit(as_index(s.component % 3));
        words = fmt::format("{}: reaction {} of {}", name, frame::wrench_names[s.component], s.of);
      }
    }
    out.push_back({{"name", name},
                   {"at_mm", scene_position(at)},
                   {"axis", {scene_digits(axis.x()), scene_digits(axis.y()), scene_digits(axis.z())}},
                   {"words", words},
                   {"guilty", is_among("sensor " + name, guilty)}});
  }
  return out;
}

}  // namespace

std::vector<std::string> changed_parts(const FrameDescription& before, const FrameDescription& after) {
  const YamlNode a = frame::tree_of(before), b = frame::tree_of(after);
  std::vector<std::string> out;
  for (const auto& [list, word] : {std::pair{"members", "member"},
                                   {"supports", "support"},
                                   {"springs", "spring"},
                                   {"sensors", "sensor"},
                                   {"loads", "load"}})
    for (const std::string& name : changed_entries(a, b, list)) {
      const std::string end = list == std::string_view("members") ? changed_end(a, b, name) : "";
      out.push_back(end.empty() ? fmt::format("{} {}", word, name) : end);
    }
  const std::vector<std::string> sections = changed_entries(a, b, "sections"),
                                 materials = changed_entries(a, b, "materials");
  for (const auto& [name, member] : after.members)
    if ((is_among(member.section, sections) || is_among(member.material, materials)) &&
        !is_among("member " + name, out))
      out.push_back("member " + name);
  return out;
}

Json frame_scene_json(const FrameDescription& f, const FrameResult& result, const std::vector<std::string>& guilty) {
  if (f.members.size() > most_drawn_members) return nullptr;
  const std::optional<FrameResult> finer = in_more_elements(f, result);
  const FrameResult& r = finer ? *finer : result;
  Json scene = {{"kind", "frame"}, {"tool", nullptr}, {"guilty", guilty}, {"ground", supports_of(f, r, guilty)}};
  for (const char* list : {"bodies", "cells", "poses"}) scene[list] = Json::array();
  Json pose = {{"label", ""}, {"pose_mm_deg", nullptr}, {"axes", Json::array()}, {"shapes", Json::array()}};
  for (const frame::Node& node : r.structure.model.nodes) pose["points_mm"].push_back(scene_position(node.position));
  put_members(scene, pose, f, r, guilty);
  scene["joints"] = springs_between(f, r, guilty);
  scene["nodes"] = nodes_of(f, r);
  scene["sensors"] = sensors_of(f, guilty);
  for (const CaseResult& c : r.cases) pose["shapes"].push_back(shape_of(f, r, c));
  scene["poses"].push_back(std::move(pose));
  return scene;
}

}  // namespace deflect::scene
