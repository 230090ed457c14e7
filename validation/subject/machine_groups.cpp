#include "validation/subject/machine_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>

#include "msa/fields/tree_edit.h"
#include "validation/subject/place_groups.h"

namespace deflect::subject {
namespace {

/// What contains a part: by path "leg", "mounts.1", "leg.portal", "leg.portal.mounts.0", with its id "", "mounts.1",
/// "portal", "portal.mounts.0".
struct Container {
  std::string path, id;
};

/// A path is a chain "leg" or "mounts.I.leg", then a part; within it the same again; at last "start" or "end". From
/// without to within; empty for a place that is not in a leg.
std::vector<Container> containers(const std::string& path) {
  const std::vector<std::string> words = segments_of(path);
  const auto join = [](const std::string& a, const std::string& b) { return a.empty() ? b : a + "." + b; };
  std::vector<Container> out;
  std::string here, id;
  std::size_t i = 0;
  const auto chain = [&](std::size_t first) {
    return first < words.size() && (words[first] == "leg" || (words[first] == "mounts" && first + 2 < words.size()));
  };
  while (chain(i)) {
    if (words[i] == "mounts") {
      here = join(here, "mounts." + words[i + 1]), id = join(id, "mounts." + words[i + 1]);
      out.push_back({here, id});
      here += ".leg";
      i += 3;
    } else {
      here = join(here, "leg");
      if (i == 0) out.push_back({here, id});
      ++i;
    }
    if (i >= words.size()) break;
    here = join(here, words[i]), id = join(id, words[i]);
    ++i;
    if (chain(i)) out.push_back({here, id});  // the part is a stage
  }
  return out;
}

bool is_end(const Place& p) { return p.path.ends_with(".start") || p.path.ends_with(".end"); }
bool is_joint(const Place& p) {
  return (p.kind == PlaceKind::joint || p.kind == PlaceKind::clamp) && !is_end(p) && !p.make.empty();
}
bool is_member(const Place& p) { return p.kind == PlaceKind::member; }
bool is_member_end(const Place& p) { return is_end(p) && p.kind != PlaceKind::line; }

std::vector<Place> those(const std::vector<Place>& all, bool (*which)(const Place&)) {
  std::vector<Place> out;
  std::copy_if(all.begin(), all.end(), std::back_inserter(out), which);
  return out;
}

/// The groups in what contains these places. `legs`: those of all legs.
void add_groups(const std::vector<Place>& inside, const std::vector<Place>& legs, const std::string& id, Groups& out) {
  const std::string head = id.empty() ? "" : id + ".", where = id.empty() ? "" : id + " ";
  const auto each = [&](bool (*which)(const Place&), const std::string& name, const std::string& words) {
    for (const auto& part : parted(those(inside, which), held_as)) out.add(part, head + name, where + words);
  };
  each([](const Place& p) { return p.kind == PlaceKind::drive; }, "drives", "drives");
  const auto type_and_hold = [](const Place& p) { return fmt::format("{} {} {}", p.make, p.axes, held_as(p)); };
  for (const auto& part : parted(those(inside, is_joint), type_and_hold))
    out.add(part, fmt::format("{}{}_joints", head, part.front().make),
            fmt::format("{}{} joints", where, part.front().make));
  const auto axes_and_hold = [](const Place& p) { return p.axes + " " + held_as(p); };
  for (const auto& part : parted(those(inside, is_joint), axes_and_hold))
    out.add(part, head + "joints", where + "passive joints");
  const auto members = [&](const std::vector<Place>& part, const std::string& name, const std::string& words,
                           const auto& same) {
    const std::size_t before = out.all.size();
    out.add(part, head + name, where + words);
    if (out.all.size() > before)
      out.all.back().whole_section = std::ssize(part) == std::count_if(legs.begin(), legs.end(), same);
  };
  for (const auto& part : parted(those(inside, is_member), [](const Place& p) { return p.make; })) {
    const std::string& section = part.front().make;
    members(part, "members." + section, "members of section " + section,
            [&](const Place& p) { return is_member(p) && p.make == section; });
  }
  members(those(inside, is_member), "members", "members", is_member);
  each(is_member_end, "ends", "ends of members");
  each([](const Place& p) { return p.kind == PlaceKind::line; }, "bars", "bars");
}

}  // namespace

std::vector<Place> groups_of(const std::vector<Place>& places) {
  std::vector<Place> legs;
  std::vector<Container> all;
  std::vector<std::vector<Container>> of;
  for (const Place& p : places) {
    std::vector<Container> around = containers(p.path);
    if (around.empty()) continue;
    for (const Container& c : around)
      if (std::none_of(all.begin(), all.end(), [&](const Container& known) { return known.path == c.path; }))
        all.push_back(c);
    legs.push_back(p);
    of.push_back(std::move(around));
  }
  Groups out(places);
  for (const Container& c : all) {
    std::vector<Place> inside;
    for (std::size_t i = 0; i < legs.size(); ++i)
      if (std::any_of(of[i].begin(), of[i].end(), [&](const Container& each) { return each.path == c.path; }))
        inside.push_back(legs[i]);
    add_groups(inside, legs, c.id, out);
  }
  add_groups(legs, legs, "legs", out);
  return std::move(out.all);
}

}  // namespace deflect::subject
