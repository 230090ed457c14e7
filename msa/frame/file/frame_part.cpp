#include "msa/frame/file/frame_part.h"

#include <algorithm>
#include <cstdlib>

#include "msa/base/index.h"

namespace deflect::frame {
namespace {

/// Whether a path leads into one of the entries: "members.beam.factor", or the entry itself.
bool leads_into(const std::string& path, const std::set<EntryName>& entries) {
  const std::vector<std::string> at = segments_of(path);
  return at.size() > 1 && entries.contains({at[0], at[1]});
}

bool any_in(const std::set<EntryName>& entries, const std::string& list) {
  return std::any_of(entries.begin(), entries.end(), [&](const EntryName& e) { return e.first == list; });
}

bool prescribed(const FrameDescription& f, const std::string& node) {
  return std::any_of(f.loads.begin(), f.loads.end(),
                     [&](const auto& load) { return find(load.second.displacements, node) != nullptr; });
}

/// Whether it may leave nothing of a number whose tolerance is a share of it, which the tolerances then refuse.
bool may_leave_nothing(const FrameDescription& f, const TreeEdit& edit) {
  const bool may = edit.action == Edit::Action::add ||
                   (edit.action == Edit::Action::multiply && std::strtod(edit.value.text.c_str(), nullptr) == 0);
  const std::string field = segments_of(edit.path).back();
  return may && std::any_of(f.tolerances.numbers.begin(), f.tolerances.numbers.end(), [&](const auto& t) {
           return segments_of(t.first).back() == field && t.second.find('%') != t.second.npos;
         });
}

template <class T>
Named<T> kept(const Named<T>& all, const std::string& list, const std::set<EntryName>& entries) {
  Named<T> out;
  for (const auto& each : all)
    if (entries.contains({list, each.first})) out.push_back(each);
  return out;
}

template <class T>
void put(Named<T>& all, const std::string& list, const std::set<EntryName>& entries, Named<T> from) {
  for (auto& [name, value] : all) {
    if (!entries.contains({list, name})) continue;
    const auto same_name = [&key = name](const auto& other) { return other.first == key; };
    value = std::move(std::find_if(from.begin(), from.end(), same_name)->second);
  }
}

}  // namespace

std::optional<std::set<EntryName>> edited_entries(const FrameDescription& f, const std::vector<TreeEdit>& edits) {
  std::set<EntryName> out;
  for (const TreeEdit& edit : edits) {
    const std::vector<std::string> at = segments_of(edit.path);
    if (at.size() < 3 || edit.action == Edit::Action::set || at[2] == "*" || at[2] == "material" ||
        may_leave_nothing(f, edit))
      return std::nullopt;
    const bool known = at[0] == "members"    ? find(f.members, at[1]) != nullptr
                       : at[0] == "supports" ? find(f.supports, at[1]) && !prescribed(f, at[1])
                       : at[0] == "springs"  ? find(f.springs, at[1]) != nullptr
                                             : at[0] == "sensors" && find(f.sensors, at[1]);
    if (!known) return std::nullopt;
    out.insert({at[0], at[1]});
  }
  return out;
}

DependentFrame part_of(const DependentFrame& whole, const std::set<EntryName>& entries) {
  const FrameDescription& f = whole.frame;
  std::set<EntryName> with = entries;
  const bool sensors = any_in(entries, "sensors");
  if (sensors)
    for (const auto& [name, sensor] : f.sensors) with.insert({"members", sensor.of});
  DependentFrame out;
  FrameDescription& part = out.frame;
  part.name = f.name;
  part.plane = f.plane;
  part.geometry = f.geometry;
  part.load_steps = f.load_steps;
  part.materials = f.materials;
  part.sections = f.sections;
  part.nodes = f.nodes;
  part.members = kept(f.members, "members", with);
  part.supports = sensors ? f.supports : kept(f.supports, "supports", entries);
  part.springs = kept(f.springs, "springs", entries);
  if (sensors) part.sensors = f.sensors;
  LoadCase some;
  some.nodes.emplace_back(f.nodes.front().first, Vector6::Unit(0));
  part.loads.emplace_back("some", std::move(some));
  for (const std::string& path : f.ours)
    if (leads_into(path, entries)) part.ours.insert(path);
  for (const auto& [path, dependence] : whole.depends)
    if (leads_into(path, entries)) out.depends.insert({path, dependence});
  return out;
}

DependentFrame with_part(DependentFrame whole, const std::set<EntryName>& entries, DependentFrame part) {
  FrameDescription& f = whole.frame;
  put(f.members, "members", entries, std::move(part.frame.members));
  put(f.supports, "supports", entries, std::move(part.frame.supports));
  put(f.springs, "springs", entries, std::move(part.frame.springs));
  put(f.sensors, "sensors", entries, std::move(part.frame.sensors));
  std::erase_if(f.ours, [&](const std::string& path) { return leads_into(path, entries); });
  f.ours.insert(part.frame.ours.begin(), part.frame.ours.end());
  std::erase_if(whole.depends, [&](const auto& each) { return leads_into(each.first, entries); });
  whole.depends.insert(part.depends.begin(), part.depends.end());
  return whole;
}

}  // namespace deflect::frame
