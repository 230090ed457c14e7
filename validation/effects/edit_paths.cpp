#include "validation/effects/edit_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/fields/field_writer.h"
#include "msa/fields/tree_edit.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/fields.h"
#include "msa/mechanism/mechanism_tree.h"
#include "msa/mechanism/place.h"
#include "validation/subject/machine_places.h"
#include "validation/subject/part_roles.h"

namespace deflect::effects {
namespace {

struct Selector {
  std::string_view name;
  bool slides, turns;
  const char* none;  // what to say where no drive is meant
};
constexpr std::string_view actuated = "<actuated>";
constexpr Selector motions[] = {{"<motion>", true, true, "nothing is driven"},
                                {"<slide>", true, false, "nothing is driven along a slide"},
                                {"<turn>", false, true, "nothing is driven about an axis"}};

struct Drive {
  std::string path;                   // of the part
  std::vector<std::size_t> freedoms;  // its actuated ones
};

void find_drives(const Named<Part>& parts, const std::string& path, std::vector<Drive>& found) {
  for (const auto& [name, part] : parts) {
    const std::string here = joined(path, name);
    if (const auto* joint = std::get_if<Joint>(&part)) {
      Drive drive{here, {}};
      const std::array<Freedom, 6> freedoms = freedoms_of(*joint);
      for (std::size_t i = 0; i < 6; ++i)
        if (freedoms[i] == Freedom::actuated) drive.freedoms.push_back(i);
      if (!drive.freedoms.empty()) found.push_back(std::move(drive));
    } else if (const auto* group = std::get_if<Parallel>(&part)) {
      find_drives(group->leg, joined(here, "leg"), found);
      for (std::size_t i = 0; i < group->mounts.size(); ++i)
        find_drives(group->mounts[i].leg, fmt::format("{}.mounts.{}.leg", here, i), found);
    }
  }
}

std::vector<Drive> drives_of(const Mechanism& m, std::optional<int> leg) {
  std::vector<Drive> found;
  if (leg) {
    find_drives(leg_parts(m, *leg), fmt::format("leg[{}]", *leg), found);
    return found;
  }
  find_drives(m.leg, "leg", found);
  for (std::size_t i = 0; i < m.mounts.size(); ++i)
    find_drives(m.mounts[i].leg, fmt::format("mounts.{}.leg", i), found);
  return found;
}

const Material& elastic(const Material& m) { return m; }
const Material& elastic(const frame::FrameMaterial& m) { return m.elastic; }

/// "materials.*.<moduli>" as E of each material and G of those that give it.
template <class Description>
std::vector<std::string> moduli(const std::string& path, const Description& m) {
  const std::vector<std::string> at = segments_of(path);
  if (at.size() != 3 || at[0] != "materials")
    throw InputError(
        fmt::format("{}: '{}' stands behind a material, as in 'materials.*.{}'", path, at.back(), at.back()));
  std::vector<std::string> out;
  for (const auto& [name, material] : m.materials) {
    if (at[1] != "*" && at[1] != name) continue;
    out.push_back(fmt::format("materials.{}.E", name));
    if (elastic(material).G) out.push_back(fmt::format("materials.{}.G", name));
  }
  if (out.empty()) throw InputError(fmt::format("{}: there is no such material", path));
  return out;
}

/// "leg.…", as the reader has seen to, in one leg.
std::string in_leg(const std::string& path, int leg) { return fmt::format("leg[{}]{}", leg, path.substr(3)); }

/// Of a bar: its beginning, x along it. Of bars one behind the other, as in a cylinder and its rod, the first: what
/// yields along the leg's line stands in it once.
std::vector<std::string> bars(const Mechanism& m) {
  std::vector<std::string> out, chains;
  for (const subject::Place& p : subject::places_of(m)) {
    if (p.kind != subject::PlaceKind::line) continue;
    const std::string bar = p.path.substr(0, p.path.rfind('.')), chain = bar.substr(0, bar.rfind('.'));
    if (std::find(chains.begin(), chains.end(), chain) != chains.end()) continue;
    chains.push_back(chain);
    out.push_back(p.path);
  }
  return out;
}

std::vector<std::string> sections_of_guides(const Mechanism& m) {
  std::vector<std::string> out;
  for (const std::string& name : subject::guided_sections(m)) out.push_back("sections." + name);
  return out;
}

/// Parts by what they are for, not by their names.
struct Role {
  std::string_view selector;
  std::vector<std::string> (*parts)(const Mechanism&);
  const char* none;
};
constexpr Role roles[] = {
    {"leg.<line>", bars, "no bar carries a force along itself alone"},
    {"leg.<pivot>", subject::pivots_of_bars, "no bar begins at a pivot with axes along it"},
    {"leg.<guide>", subject::guides, "no slide that is driven holds a member"},
    {"leg.<guided>", subject::guided_members, "no slide that is driven holds a member"},
    {"leg.<carriage>", subject::carriages, "no fixed joint stands at the tip of a member that a driven slide holds"},
    {"leg.<seat>", subject::seats, "no leg ends in a fixed joint with the axes of the platform"},
    {"sections.<guided>", sections_of_guides, "no slide that is driven holds a member"},
};

std::vector<std::string> of_role(const Role& role, const std::string& rest, const Mechanism& m,
                                 std::optional<int> leg) {
  std::vector<std::string> out;
  for (const std::string& path : role.parts(m))
    if (!leg || path.starts_with("leg.")) out.push_back((leg ? in_leg(path, *leg) : path) + rest);
  if (out.empty()) throw InputError(fmt::format("{}{}: {}", role.selector, rest, role.none));
  return out;
}

/// "leg.<actuated>.<slide>" as the paths of the drives.
std::vector<std::string> selected(const std::string& path, const Mechanism& m, std::optional<int> leg) {
  if (path.find('<') == path.npos) return {leg ? in_leg(path, *leg) : path};
  if (path.ends_with(".<moduli>")) return moduli(path, m);
  for (const Role& role : roles)
    if (path.starts_with(role.selector)) return of_role(role, path.substr(role.selector.size()), m, leg);
  const std::string head = fmt::format("leg.{}.", actuated);
  std::string rest = path.starts_with(head) ? path.substr(head.size()) : path;
  const Selector* motion = nullptr;
  for (const Selector& each : motions)
    if (rest.starts_with(each.name)) motion = &each;
  if (motion) rest = rest.substr(motion->name.size());
  if (rest.find('<') != rest.npos)
    throw InputError(
        fmt::format("{}: a path with selectors begins with '{}', then '<motion>', '<slide>', '<turn>' or "
                    "a field",
                    path, head));
  std::vector<std::string> out;
  for (const Drive& drive : drives_of(m, leg)) {
    if (!motion) out.push_back(joined(drive.path, rest));
    for (const std::size_t i : drive.freedoms)
      if (motion && (i < 3 ? motion->slides : motion->turns))
        out.push_back(fmt::format("{}.{}{}", drive.path, freedom_names[i], rest));
  }
  if (out.empty()) throw InputError(fmt::format("{}: {}", path, motion ? motion->none : motions[0].none));
  return out;
}

/// Throws what is wrong with a path, beginning with the path itself.
void require_there(const YamlNode& tree, const std::string& path, const Mechanism& m) {
  if (!path.starts_with("leg[")) {
    places(tree, path, "");
    return;
  }
  const std::size_t bracket = path.find(']');
  const int leg = std::stoi(path.substr(4, bracket - 4));
  places(tree_of(leg_parts(m, leg), {}, m), path.substr(bracket + 2), path.substr(0, bracket + 2));
}

/// What stands at `path` stands inside what `variation` replaced.
bool inside(const std::string& path, const std::string& variation) {
  const std::vector<std::string> at = segments_of(path), outer = segments_of(variation);
  const auto same = [](const std::string& a, const std::string& b) { return a == b || a == "*"; };
  return outer.size() <= at.size() && std::equal(at.begin(), at.begin() + as_index(outer.size()), outer.begin(), same);
}

/// An edit of every leg does not reach a leg whose variation holds the whole field: there it is made once more.
std::vector<std::string> in_varied_legs_too(std::vector<std::string> paths, const Mechanism& m) {
  for (std::size_t i = 0, count = paths.size(); i < count; ++i) {
    if (!paths[i].starts_with("leg.")) continue;
    const std::string rest = paths[i].substr(4);
    std::set<int> legs;
    for (const Variation& v : m.variations)
      if (inside(rest, v.path)) legs.insert(v.leg);
    for (const int leg : legs) paths.push_back(fmt::format("leg[{}].{}", leg, rest));
  }
  return paths;
}

/// What the first of the paths that is there becomes.
std::vector<std::string> first_there(const EffectEdit& edit,
                                     const std::function<std::vector<std::string>(const std::string&)>& become) {
  std::string first_error;
  for (const std::string& path : edit.paths) {
    auto found = outcome_of<InputError>([&] { return become(path); });
    if (found) return std::move(*found);
    if (first_error.empty()) first_error = found.why;
  }
  throw InputError(first_error);
}

std::vector<std::string> first_alternative(const EffectEdit& edit, const Mechanism& m, std::optional<int> leg) {
  if (edit.paths.size() == 1) return selected(edit.paths.front(), m, leg);
  const YamlNode tree = tree_of(m);
  return first_there(edit, [&](const std::string& path) {
    std::vector<std::string> all = selected(path, m, leg);
    for (const std::string& each : all) require_there(tree, each, m);
    return all;
  });
}

std::vector<std::string> selected(const std::string& path, const frame::FrameDescription& f) {
  if (path.ends_with(".<moduli>")) return moduli(path, f);
  if (path.find('<') != path.npos || path.starts_with("leg.") || path.starts_with("leg["))
    throw InputError(fmt::format("{}: a frame has no legs and nothing that is driven", path));
  return {path};
}

}  // namespace

std::vector<std::string> paths_of(const EffectEdit& edit, const frame::FrameDescription& f) {
  if (edit.paths.size() == 1) return selected(edit.paths.front(), f);
  const YamlNode tree = frame::tree_of(f);
  return first_there(edit, [&](const std::string& path) {
    std::vector<std::string> all = selected(path, f);
    for (const std::string& each : all) places(tree, each, "");
    return all;
  });
}

std::vector<std::string> paths_of(const EffectEdit& edit, const subject::Subject& s) {
  return s.frame() ? paths_of(edit, *s.frame()) : paths_of(edit, *s.machine(), std::nullopt);
}

bool edits_only(const Effect& e, const std::string& part, const subject::Subject& s) {
  const auto is_within = [&](std::string path) {
    if (const std::size_t leg = path.find('['); path.starts_with("leg[")) path.erase(leg, path.find(']') + 1 - leg);
    return path == part || path.starts_with(part + '.');
  };
  return std::all_of(e.edits.begin(), e.edits.end(), [&](const EffectEdit& edit) {
    const std::vector<std::string> paths = paths_of(edit, s);
    return std::all_of(paths.begin(), paths.end(), is_within);
  });
}

std::vector<std::string> paths_of(const EffectEdit& edit, const Mechanism& m, std::optional<int> leg) {
  return in_varied_legs_too(first_alternative(edit, m, leg), m);
}

}  // namespace deflect::effects
