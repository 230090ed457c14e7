#include "msa/mechanism/tolerances.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/units.h"
#include "msa/fields/tree_edit.h"
#include "msa/fields/yaml_tree.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/deviation.h"
#include "msa/mechanism/joint_table.h"
#include "msa/mechanism/numbers.h"
#include "msa/mechanism/place.h"

namespace deflect {
namespace {

using Segments = std::vector<std::string>;

bool is_index(const std::string& segment) {
  return !segment.empty() &&
         std::all_of(segment.begin(), segment.end(), [](unsigned char c) { return std::isdigit(c); });
}

struct Number : DescribedNumber {
  std::size_t index = 0;
  std::string kind, field;  ///< "drive" and "stiffness"; "" where it is of no kind of place
  Segments at;              ///< of the path
};

/// Kinds of place by the beginning of the paths of their numbers.
using Kinds = std::vector<std::pair<std::string, std::string>>;

void find_kinds(const Named<Part>& parts, const std::string& path, Kinds& out) {
  for (const auto& [name, part] : parts) {
    const std::string here = joined(path, name);
    if (const auto* joint = std::get_if<Joint>(&part)) {
      const std::array<Freedom, 6> freedoms = freedoms_of(*joint);
      for (std::size_t i = 0; i < 6; ++i)
        out.emplace_back(joined(here, freedom_names[i]), freedoms[i] == Freedom::actuated ? "drive" : "joint");
    } else if (std::holds_alternative<Member>(part)) {
      out.emplace_back(joined(here, "start"), "member_end");
      out.emplace_back(joined(here, "end"), "member_end");
      out.emplace_back(here, "member");
    } else if (const auto* group = std::get_if<Parallel>(&part)) {
      find_kinds(group->leg, joined(here, "leg"), out);
      for (std::size_t i = 0; i < group->mounts.size(); ++i)
        find_kinds(group->mounts[i].leg, fmt::format("{}.mounts.{}.leg", here, i), out);
    }
  }
}

Kinds kinds_of(const Mechanism& m) {
  Kinds out;
  for (std::size_t i = 0; i < m.legs.size(); ++i) find_kinds(m.legs[i], fmt::format("leg[{}]", i + 1), out);
  for (const auto& [name, section] : m.sections) out.emplace_back("sections." + name, "section");
  for (const auto& [name, material] : m.materials) out.emplace_back("materials." + name, "material");
  return out;
}

std::string without_indices(const Segments& at) {
  std::string out;
  for (const std::string& segment : at)
    if (!is_index(segment)) out = joined(out, segment);
  return out;
}

/// What a model reads: legs one by one instead of what they have in common.
bool counts(const Segments& at) {
  static const std::set<std::string> apart = {"leg", "tolerances", "workspace"};
  const bool own_leg = at.size() > 2 && at[0] == "mounts" && at[2] == "leg";
  return !apart.contains(at.front()) && !own_leg;
}

std::vector<Number> counted_numbers(const Mechanism& m) {
  const Kinds kinds = kinds_of(m);
  const std::vector<DescribedNumber> all = described_numbers(m);
  std::vector<Number> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Number number{all[i], i, "", "", segments_of(all[i].path)};
    if (!counts(number.at)) continue;
    for (const auto& [path, kind] : kinds)
      if (number.path.starts_with(path + ".")) {
        number.kind = kind;
        number.field = without_indices(segments_of(number.path.substr(path.size() + 1)));
        break;
      }
    out.push_back(std::move(number));
  }
  return out;
}

bool names_one(const Segments& key, const Segments& at, std::size_t i, std::size_t k) {
  if (i == key.size()) return std::all_of(at.begin() + as_index(k), at.end(), is_index);
  if (k == at.size()) return false;
  const bool leg = k == 0 && key[i] == "leg" && at[k].starts_with("leg[");
  if ((leg || key[i] == at[k] || key[i] == "*") && names_one(key, at, i + 1, k + 1)) return true;
  return is_index(at[k]) && names_one(key, at, i, k + 1);
}

/// "mounts.2.leg.…" as "leg[3].…", which it becomes in a resolved mechanism.
Segments resolved_key(const std::string& key) {
  Segments at = segments_of(key);
  if (at.size() < 3 || at[0] != "mounts" || !is_index(at[1]) || at[2] != "leg" || at[1].size() > 6) return at;
  at[2] = fmt::format("leg[{}]", std::stoi(at[1]) + 1);
  at.erase(at.begin(), at.begin() + 2);
  return at;
}

bool places_a_joint(const Number& n) {
  const std::string path = without_indices(n.at);
  for (const char* end :
       {".base.shift", ".platform.shift", ".offset", ".dh.a", ".dh.d", ".modified_dh.a", ".modified_dh.d"})
    if (path.ends_with(end)) return path.starts_with("mounts") || path.starts_with("leg[");
  return false;
}

bool means(const std::string& key, const Number& n) {
  if (key == "joint.position") return places_a_joint(n);
  if (key == "member.length") return n.kind == "member" && n.field == "along";
  const std::size_t dot = key.find('.');
  if (dot != key.npos && !n.kind.empty() && key.substr(0, dot) == n.kind && key.substr(dot + 1) == n.field) return true;
  return names_one(resolved_key(key), n.at, 0, 0);
}

bool relative(const std::string& value) { return value.ends_with('%'); }

double sigma_of(const std::string& value, Dimension d) {
  return relative(value) ? parse_quantity(value, Dimension::ratio) : parse_quantity(value, d);
}

/// Whether points of a table stand there, two numbers each.
bool is_table(const std::string& segment) { return segment == "points" || segment == "unloading"; }

/// "leg 2 elbow rz stiffness", "leg 2 elbow rz points 4 deflection": the path in words.
std::string words(const Number& n) {
  std::string out;
  const auto add = [&](const std::string& word) { out += (out.empty() ? "" : " ") + word; };
  for (std::size_t i = 0; i < n.at.size(); ++i) {
    const std::string& s = n.at[i];
    if (i == 0 && s.starts_with("leg["))
      add("leg " + s.substr(4, s.size() - 5));
    else if (i == 0 && (s == "sections" || s == "materials" || s == "kinematics"))
      continue;
    else if (i == 0 && s == "mounts")
      add("leg");
    else if (i == 1 && n.at[0] == "mounts" && is_index(s))
      add(std::to_string(std::stoi(s) + 1));
    else if (i > 0 && i + 1 < n.at.size() && is_index(s) && is_table(n.at[i - 1]))
      add(fmt::format("{} {}", std::stoi(s) + 1, n.at[i + 1] == "0" ? "load" : "deflection"));
    else if (i > 1 && is_table(n.at[i - 2]) && is_index(s))
      continue;  // said already
    else if (is_index(s) && i + 1 == n.at.size() && s.size() == 1 && s[0] < '3')
      add(std::string(1, "xyz"[s[0] - '0']));
    else if (!is_index(s))
      add(s);
  }
  return out;
}

/// Members along themselves: the three components of each move together.
std::vector<NumberMove> lengths(const std::vector<Number>& components, double sigma, bool is_relative) {
  std::vector<NumberMove> out;
  for (std::size_t i = 0; i + 2 < components.size(); i += 3) {
    const Vector3 along(components[i].value, components[i + 1].value, components[i + 2].value);
    const Vector3 shift = (is_relative ? sigma * along.norm() : sigma) * along.normalized();
    Number member = components[i];
    member.at.back() = "length";
    std::erase(member.at, "along");
    NumberMove move{words(member), sigma};
    for (std::size_t k = 0; k < 3; ++k)
      if (shift(as_index(k)) != 0) move.add(components[i + k].index, components[i + k].value, shift(as_index(k)));
    out.push_back(std::move(move));
  }
  return out;
}

std::vector<Number> meant(const std::vector<Number>& all, const std::string& key) {
  std::vector<Number> out;
  std::copy_if(all.begin(), all.end(), std::back_inserter(out), [&](const Number& n) { return means(key, n); });
  return out;
}

std::vector<NumberMove> moves_of(const std::vector<Number>& numbers, const std::string& key, const std::string& value) {
  std::vector<NumberMove> out;
  if (numbers.empty()) return out;
  if (key == "member.length") return lengths(numbers, sigma_of(value, Dimension::length), relative(value));
  for (const Number& n : numbers) {
    const double sigma = sigma_of(value, n.dimension), shift = relative(value) ? sigma * n.value : sigma;
    if (shift == 0) continue;
    out.push_back({words(n), sigma});
    out.back().add(n.index, n.value, shift);
  }
  return out;
}

bool named_for_six_psu(const Mechanism& m, const std::string& key) {
  return std::holds_alternative<SixPsu>(m.kinematics) && (key == "member.length" || key == "joint.position");
}

/// What a key could have been.
std::vector<std::string> known_keys(const std::vector<Number>& all) {
  std::set<std::string> out;
  for (const Number& n : all) {
    Segments at = n.at;
    if (at.front().starts_with("leg[")) at.front() = "leg";
    out.insert(without_indices(at));
    if (!n.kind.empty()) out.insert(joined(n.kind, n.field));
    if (places_a_joint(n)) out.insert("joint.position");
    if (n.kind == "member" && n.field == "along") out.insert("member.length");
  }
  return {out.begin(), out.end()};
}

}  // namespace

std::vector<NumberMove> number_moves(const Mechanism& m) {
  std::vector<NumberMove> out;
  if (m.tolerances.numbers.empty()) return out;
  const std::vector<Number> all = counted_numbers(m);
  for (const auto& [key, value] : m.tolerances.numbers)
    if (!named_for_six_psu(m, key))
      for (NumberMove& move : moves_of(meant(all, key), key, value)) out.push_back(std::move(move));
  return out;
}

Mechanism moved(const Mechanism& resolved, const NumberMove& move, double times) {
  Mechanism out = resolved;
  for_each_number(out, [&](std::size_t i, double& x) {
    for (const auto& [index, shift] : move.shifts)
      if (index == i) x += times * shift;
  });
  return out;
}

Tolerances named_tolerances(const Mechanism& m) {
  Tolerances out = m.tolerances;
  for (const auto& [key, value] : m.tolerances.numbers) {
    if (!named_for_six_psu(m, key)) continue;
    double& sigma = key == "member.length" ? out.link_length : out.joint_position;
    sigma = std::hypot(sigma, sigma_of(value, Dimension::length));
  }
  return out;
}

void check_tolerance(const Mechanism& m, const std::string& key, const std::string& value) {
  const std::vector<Number> all = counted_numbers(m), numbers = meant(all, key);
  const bool named = named_for_six_psu(m, key);
  if (numbers.empty() && !named) {
    const std::string near = nearest(key, known_keys(all));
    throw InputError(
        fmt::format("no number of this device has this tolerance{}: a key is a kind of place and a field "
                    "('drive.stiffness'), or a path ('leg.elbow.rz.stiffness')",
                    near.empty() ? "" : fmt::format(", did you mean '{}'?", near)));
  }
  if (named && relative(value))
    throw InputError(fmt::format("'{}' must be a length: write for example '0.1 mm'", value));
  const double sigma = sigma_of(value, named ? Dimension::length : numbers.front().dimension);
  require_deviation(sigma, value, named ? Dimension::length : numbers.front().dimension);
  if (!named && sigma > 0 && moves_of(numbers, key, value).empty())
    throw InputError(fmt::format("'{}' is a share of a number that is zero: give a unit instead", value));
}

}  // namespace deflect
