#include "msa/mechanism/inside.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/fields/tree_edit.h"
#include "msa/fields/yaml_tree.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/place.h"

namespace deflect {
namespace {

std::optional<std::size_t> number(const std::string& word) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw InputError(fmt::format("'{}': {}", path, why));
}

/// The number of a leg or branch at words[i], from 1; where there is only one it may be missing.
std::size_t numbered(const std::string& path, const std::vector<std::string>& words, std::size_t& i, std::size_t count,
                     const char* what) {
  const std::optional<std::size_t> given = i < words.size() ? number(words[i]) : std::nullopt;
  if (!given && count == 1) return 0;
  if (!given || *given < 1 || *given > count)
    refuse(path, fmt::format("say which {} from 1 to {}, as in 'leg.2.actuator'", what, count));
  ++i;
  return *given - 1;
}

struct Found {
  NamedPart named;
  const Part* part = nullptr;
  std::vector<std::string> rest;  // of the path
};

/// `leg`: keeps the parts that `part` is one of.
Found found_in(const Mechanism& m, const std::string& path, Named<Part>& leg) {
  const std::vector<std::string> words = segments_of(path);
  if (words.front() != "leg") refuse(path, "a path to a part begins with 'leg', as in 'leg.2.actuator'");
  Found out;
  std::size_t i = 1;
  out.named.leg = static_cast<int>(numbered(path, words, i, as_size(leg_count(m)), "leg")) + 1;
  leg = leg_parts(m, out.named.leg);
  for (const Named<Part>* parts = &leg;;) {
    std::vector<std::string> known;
    for (const auto& [name, part] : *parts)
      if (!std::holds_alternative<Offset>(part)) known.push_back(name);
    const std::string name = i < words.size() ? words[i] : "";
    ++i;
    const auto at = std::find_if(parts->begin(), parts->end(), [&](const auto& p) { return p.first == name; });
    if (at == parts->end() || std::holds_alternative<Offset>(at->second))
      refuse(path, name.empty() ? fmt::format("names no part (known: {})", fmt::join(known, ", "))
                                : fmt::format("there is no joint or member '{}'{} (known: {})", name,
                                              suggestion(name, known), fmt::join(known, ", ")));
    out.named.names.push_back(name);
    out.part = &at->second;
    const auto* group = std::get_if<Parallel>(out.part);
    if (!group) break;
    const std::size_t branches = std::max<std::size_t>(group->mounts.size(), 1);
    const std::size_t branch = numbered(path, words, i, branches, "branch");
    out.named.branches.push_back(branch);
    parts =
        branch < group->mounts.size() && !group->mounts[branch].leg.empty() ? &group->mounts[branch].leg : &group->leg;
  }
  for (; i < words.size(); ++i) out.rest.push_back(words[i]);
  return out;
}

const std::string& name_of(const PlacedPart& part) {
  return std::visit([](const auto& p) -> const std::string& { return p.part; }, part);
}

const PlacedLeg& leg_of(const Inside& at, const Configuration& c, std::size_t depth) {
  const PlacedLeg* leg = &c.legs.at(at.leg);
  for (std::size_t k = 0; k < depth; ++k)
    leg = &std::get<PlacedParallel>(leg->parts.at(at.parts[2 * k])).branches.at(at.parts[2 * k + 1]);
  return *leg;
}

}  // namespace

NamedPart part_of_drive(const Mechanism& m, const std::string& path) {
  Named<Part> leg;
  Found found = found_in(m, path, leg);
  const auto* joint = std::get_if<Joint>(found.part);
  if (!joint) refuse(path, "is a member: the force of a drive is read at a driven joint");
  const std::array<Freedom, 6> freedoms = freedoms_of(*joint);
  std::vector<std::string> driven;
  for (std::size_t i = 0; i < 6; ++i)
    if (freedoms[i] == Freedom::actuated) driven.push_back(freedom_names[i]);
  if (driven.empty()) refuse(path, fmt::format("the joint '{}' is not driven", found.named.names.back()));
  if (found.rest.size() > 1 || (found.rest.empty() && driven.size() > 1))
    refuse(path, fmt::format("say which of its driven freedoms: {}", fmt::join(driven, ", ")));
  const std::string wanted = found.rest.empty() ? driven.front() : found.rest.front();
  if (std::find(driven.begin(), driven.end(), wanted) == driven.end())
    refuse(path, fmt::format("'{}' is not a driven freedom of '{}' (driven: {})", wanted, found.named.names.back(),
                             fmt::join(driven, ", ")));
  found.named.freedom = as_size(std::find(freedom_names.begin(), freedom_names.end(), wanted) - freedom_names.begin());
  return found.named;
}

NamedPart part_of_body(const Mechanism& m, const std::string& path) {
  Named<Part> leg;
  Found found = found_in(m, path, leg);
  if (!found.rest.empty()) refuse(path, fmt::format("ends with the part '{}'", found.named.names.back()));
  return found.named;
}

Inside placed(const NamedPart& named, const Configuration& c) {
  Inside out{as_size(named.leg - 1), {}, named.freedom};
  const PlacedLeg* leg = &c.legs.at(out.leg);
  for (std::size_t k = 0; k < named.names.size(); ++k) {
    const bool last = k + 1 == named.names.size();
    // A joint of many freedoms is several in series: the drive is one of them, the body is behind the last.
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < leg->parts.size(); ++i) {
      if (name_of(leg->parts[i]) != named.names[k]) continue;
      const PlacedJoint* joint = joint_of(leg->parts[i]);
      if (last && named.freedom && found && !(joint && joint->freedoms.at(*named.freedom) == Freedom::actuated))
        continue;
      found = i;
    }
    if (!found) throw InputError(fmt::format("{} has no part '{}' to read", leg->name, named.names[k]));
    out.parts.push_back(*found);
    if (last) break;
    out.parts.push_back(named.branches[k]);
    leg = &std::get<PlacedParallel>(leg->parts[*found]).branches.at(named.branches[k]);
  }
  return out;
}

std::optional<NamedPart> inside_part(const Mechanism& m, const PointSensor& s) {
  if (!s.drive.empty()) return part_of_drive(m, s.drive);
  if (s.body == "platform" || s.body == "tool") return std::nullopt;
  return part_of_body(m, s.body);
}

const PlacedPart& part_at(const Inside& at, const Configuration& c) {
  return leg_of(at, c, at.parts.size() / 2).parts.at(at.parts.back());
}

PartEnd end_of(const Inside& at, const Configuration& c) {
  const PlacedPart& part = part_at(at, c);
  if (const auto* member = std::get_if<PlacedMember>(&part)) return {member->p_W_end, member->R_WM};
  const PlacedJoint& joint = *joint_of(part);
  return {joint.p_W, joint.R_WJ};
}

void complete_sensor(const Mechanism& m, PointSensor& s) {
  const std::optional<NamedPart> part = inside_part(m, s);
  if (!part || !part->freedom) return;
  s.rotation = *part->freedom >= 3;
  s.direction = freedom_names.at(*part->freedom);
}

}  // namespace deflect
