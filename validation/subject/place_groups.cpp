#include "validation/subject/place_groups.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

namespace deflect::subject {

Groups::Groups(const std::vector<Place>& places) {
  for (const Place& p : places) ids_.insert(id_of(p));
}

void Groups::add(const std::vector<Place>& parts, const std::string& id, const std::string& words) {
  if (parts.size() < 2) return;
  std::set<std::string> set;
  for (const Place& p : parts) set.insert(fmt::format("{} {}", p.path, fmt::join(p.freedoms, " ")));
  if (set.size() < 2 || !sets_.insert(std::move(set)).second) return;
  Place group = parts.front();
  for (std::size_t i = 1; i < parts.size(); ++i) {
    group.others.push_back({parts[i].part, parts[i].path, parts[i].freedoms});
    group.expands = group.expands && parts[i].expands;
  }
  group.misfit_shows = false;  // parts that are all too long by one amount have no cause in common
  group.group = id;
  group.group_words = words;
  if (ids_.contains(id_of(group))) {
    group.group += ".like_" + group.part;
    group.group_words += " like " + group.part;
  }
  if (ids_.insert(id_of(group)).second) all.push_back(std::move(group));
}

std::vector<std::vector<Place>> parted(const std::vector<Place>& places,
                                       const std::function<std::string(const Place&)>& key) {
  std::vector<std::vector<Place>> out;
  std::map<std::string, std::size_t> known;
  for (const Place& p : places) {
    const auto [at, is_new] = known.try_emplace(key(p), out.size());
    if (is_new) out.emplace_back();
    out[at->second].push_back(p);
  }
  return out;
}

std::string held_as(const Place& p) {
  return fmt::format("{} {} {}", fmt::join(p.freedoms, " "), fmt::underlying(p.hold), p.one_stiffness);
}

}  // namespace deflect::subject
