#include "validation/subject/part_roles.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "msa/base/index.h"
#include "msa/mechanism/joint_table.h"
#include "msa/mechanism/mechanism_tree.h"
#include "msa/mechanism/place.h"

namespace deflect::subject {
namespace {

/// Whether a freedom that has a law counts as free.
enum class Sprung { held, free };

/// Of a pivot: its free turns.
std::optional<int> free_turns(const Part& part, Sprung sprung) {
  const auto* joint = std::get_if<Joint>(&part);
  if (!joint) return std::nullopt;
  const std::array<Freedom, 6> f = freedoms_of(*joint);
  int turns = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const bool held = sprung == Sprung::held && !joint->laws[i].empty();
    if (f[i] == Freedom::free && !held && i < 3) return std::nullopt;
    if (f[i] == Freedom::free && !held) ++turns;
  }
  return turns;
}

/// The nearest part in that direction that turns freely; nothing where something else comes before it.
std::optional<std::size_t> pivot_from(const Named<Part>& parts, std::size_t member, std::ptrdiff_t step,
                                      Sprung sprung) {
  for (std::ptrdiff_t i = as_index(member) + step; 0 <= i && i < std::ssize(parts); i += step) {
    const Part& part = nth(parts, i).second;
    const std::optional<int> turns = free_turns(part, sprung);
    if (std::holds_alternative<Parallel>(part) || (std::holds_alternative<Joint>(part) && !turns)) return std::nullopt;
    if (turns && *turns > 0) return as_size(i);
  }
  return std::nullopt;
}

bool leaves_one_turn(const Named<Part>& chain, std::size_t member, Sprung sprung) {
  const auto turns = [&](std::ptrdiff_t step) {
    const std::optional<std::size_t> at = pivot_from(chain, member, step, sprung);
    return at ? *free_turns(chain[*at].second, sprung) : 0;
  };
  return turns(-1) + turns(1) >= 5;
}

bool is_driven_slide(const Part& part) {
  const auto* joint = std::get_if<Joint>(&part);
  if (!joint) return false;
  const std::array<Freedom, 6> f = freedoms_of(*joint);
  return std::find(f.begin(), f.begin() + 3, Freedom::actuated) != f.begin() + 3;
}

bool is_fixed(const Part& part) {
  const auto* joint = std::get_if<Joint>(&part);
  if (!joint) return false;
  const std::array<Freedom, 6> f = freedoms_of(*joint);
  return std::all_of(f.begin(), f.end(), [](Freedom each) { return each == Freedom::rigid; });
}

bool is_guided(const Named<Part>& parts, std::size_t i) {
  return i > 0 && std::holds_alternative<Member>(parts[i].second) && is_driven_slide(parts[i - 1].second);
}

using InChain = std::function<void(const Named<Part>&, std::size_t, const std::string& path)>;

void for_each_part(const Named<Part>& parts, const std::string& path, const InChain& found) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string here = joined(path, parts[i].first);
    found(parts, i, here);
    if (const auto* group = std::get_if<Parallel>(&parts[i].second)) {
      for_each_part(group->leg, here + ".leg", found);
      for (std::size_t k = 0; k < group->mounts.size(); ++k)
        for_each_part(group->mounts[k].leg, fmt::format("{}.mounts.{}.leg", here, k), found);
    }
  }
}

/// Paths of the parts for which `is` holds.
std::vector<std::string> paths(const Mechanism& m, const std::function<bool(const Named<Part>&, std::size_t)>& is) {
  std::vector<std::string> out;
  const InChain add = [&](const Named<Part>& parts, std::size_t i, const std::string& path) {
    if (is(parts, i)) out.push_back(path);
  };
  for_each_part(m.leg, "leg", add);
  for (std::size_t i = 0; i < m.mounts.size(); ++i)
    for_each_part(m.mounts[i].leg, fmt::format("mounts.{}.leg", i), add);
  return out;
}

}  // namespace

std::vector<std::string> guided_members(const Mechanism& m) { return paths(m, is_guided); }

std::vector<std::string> guides(const Mechanism& m) {
  return paths(m,
               [](const Named<Part>& parts, std::size_t i) { return i + 1 < parts.size() && is_guided(parts, i + 1); });
}

std::vector<std::string> carriages(const Mechanism& m) {
  return paths(m, [](const Named<Part>& parts, std::size_t i) {
    return i > 0 && is_fixed(parts[i].second) && is_guided(parts, i - 1);
  });
}

std::vector<std::string> seats(const Mechanism& m) {
  return paths(m, [](const Named<Part>& parts, std::size_t i) {
    return i + 1 == parts.size() && is_fixed(parts[i].second) && std::get<Joint>(parts[i].second).axes == "platform";
  });
}

std::vector<std::string> pivots_of_bars(const Mechanism& m) {
  return paths(m, [](const Named<Part>& parts, std::size_t i) {
    const auto* joint = std::get_if<Joint>(&parts[i].second);
    if (!joint || joint->axes != "link") return false;
    for (std::size_t k = i + 1; k < parts.size(); ++k)
      if (std::holds_alternative<Member>(parts[k].second) && leaves_one_turn(parts, k, Sprung::free))
        return pivot_from(parts, k, -1, Sprung::free) == i;
    return false;
  });
}

std::vector<std::string> guided_sections(const Mechanism& m) {
  std::vector<std::string> out;
  paths(m, [&](const Named<Part>& parts, std::size_t i) {
    if (!is_guided(parts, i)) return false;
    const std::string& section = std::get<Member>(parts[i].second).section;
    if (std::find(out.begin(), out.end(), section) == out.end()) out.push_back(section);
    return true;
  });
  return out;
}

bool is_bar(const Named<Part>& chain, std::size_t part) { return leaves_one_turn(chain, part, Sprung::held); }

}  // namespace deflect::subject
