#include "msa/frame/file/frame_tolerances.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/units.h"
#include "msa/fields/tree_edit.h"
#include "msa/fields/yaml_tree.h"
#include "msa/frame/file/frame_file.h"
#include "msa/frame/file/member_axes.h"
#include "msa/mechanism/deviation.h"

namespace deflect::frame {
namespace {

using Segments = std::vector<std::string>;

constexpr std::array<std::pair<const char*, const char*>, 6> kinds = {{{"member", "members"},
                                                                       {"section", "sections"},
                                                                       {"material", "materials"},
                                                                       {"spring", "springs"},
                                                                       {"support", "supports"},
                                                                       {"node", "nodes"}}};

struct Number : DescribedNumber {
  std::size_t index = 0;
  Segments at;
};

bool is_index(const std::string& segment) {
  return !segment.empty() &&
         std::all_of(segment.begin(), segment.end(), [](unsigned char c) { return std::isdigit(c); });
}

/// Of what a frame is built of, not of its loads and sensors.
std::vector<Number> numbers_of(const FrameDescription& f) {
  std::vector<Number> out;
  const std::vector<DescribedNumber> all = described_numbers(f);
  for (std::size_t i = 0; i < all.size(); ++i) {
    Number n{all[i], i, segments_of(all[i].path)};
    if (std::any_of(kinds.begin(), kinds.end(), [&](const auto& k) { return n.at.front() == k.second; }))
      out.push_back(std::move(n));
  }
  return out;
}

/// The list, any entry of it, and the rest of the key; the key itself where it begins with no kind of part.
Segments full_key(const std::string& key) {
  Segments at = segments_of(key);
  for (const auto& [kind, list] : kinds)
    if (at.front() == kind) {
      at.front() = list;
      at.insert(at.begin() + 1, "*");
      break;
    }
  return at;
}

bool names_one(const Segments& key, const Segments& at, std::size_t i, std::size_t k) {
  if (i == key.size()) return std::all_of(at.begin() + as_index(k), at.end(), is_index);
  if (k == at.size()) return false;
  if ((key[i] == at[k] || key[i] == "*") && names_one(key, at, i + 1, k + 1)) return true;
  return k > 1 && is_index(at[k]) && names_one(key, at, i, k + 1);
}

bool means(const FrameDescription& f, const std::string& key, const Number& n) {
  if (key == "node.position")
    return n.at.front() == "nodes" && (f.plane == Plane::none || n.at.back() != std::to_string(normal_axis(f.plane)));
  return names_one(full_key(key), n.at, 0, 0);
}

std::vector<Number> meant(const FrameDescription& f, const std::vector<Number>& all, const std::string& key) {
  std::vector<Number> out;
  std::copy_if(all.begin(), all.end(), std::back_inserter(out), [&](const Number& n) { return means(f, key, n); });
  return out;
}

bool relative(const std::string& value) { return value.ends_with('%'); }

double sigma_of(const std::string& value, Dimension d) {
  return parse_quantity(value, relative(value) ? Dimension::ratio : d);
}

/// "beam bending_factor", "node C x", "support B uz stiffness".
std::string words(const Number& n) {
  std::string out;
  for (std::size_t i = 0; i < n.at.size(); ++i) {
    const std::string& s = n.at[i];
    std::string word = s;
    if (i == 0) word = s == "supports" ? "support" : s == "nodes" ? "node" : s == "springs" ? "spring" : "";
    if (i > 1 && is_index(s)) word = n.at[0] == "nodes" ? std::string(1, "xyz"[s[0] - '0']) : "";
    if (!word.empty()) out += (out.empty() ? "" : " ") + word;
  }
  return out;
}

std::vector<NumberMove> moves_of(const std::vector<Number>& numbers, const std::string& value) {
  std::vector<NumberMove> out;
  for (const Number& n : numbers) {
    const double sigma = sigma_of(value, n.dimension), shift = relative(value) ? sigma * n.value : sigma;
    if (shift == 0) continue;
    out.push_back({words(n), sigma});
    out.back().add(n.index, n.value, shift);
  }
  return out;
}

/// The moduli of each material.
void add_moduli(const FrameDescription& f, const std::vector<Number>& all, std::vector<NumberMove>& out) {
  const double sigma = f.tolerances.modulus;
  if (!(sigma > 0)) return;
  for (const auto& [name, material] : f.materials) {
    NumberMove move{f.materials.size() > 1 ? "modulus of " + name : "modulus", sigma};
    for (const Number& n : all)
      if (n.at.front() == "materials" && n.at[1] == name && (n.at.back() == "E" || n.at.back() == "G"))
        move.add(n.index, n.value, sigma * n.value);
    out.push_back(std::move(move));
  }
}

std::vector<std::string> known_keys(const std::vector<Number>& all) {
  std::set<std::string> out = {"node.position"};
  for (const Number& n : all)
    for (const auto& [kind, list] : kinds) {
      if (n.at.front() != list || n.at.size() < 3) continue;
      std::string key = kind;
      for (std::size_t i = 2; i < n.at.size(); ++i)
        if (!is_index(n.at[i])) key = joined(key, n.at[i]);
      out.insert(key);
    }
  return {out.begin(), out.end()};
}

}  // namespace

std::vector<NumberMove> number_moves(const FrameDescription& f) {
  std::vector<NumberMove> out;
  if (f.tolerances.numbers.empty() && f.tolerances.modulus == 0) return out;
  const std::vector<Number> all = numbers_of(f);
  add_moduli(f, all, out);
  for (const auto& [key, value] : f.tolerances.numbers)
    for (NumberMove& move : moves_of(meant(f, all, key), value)) out.push_back(std::move(move));
  return out;
}

namespace {

/// Sections of members whose ends moved do not turn about the members: the vector for local y is the y drawn.
void keep_axes(FrameDescription& built, const FrameDescription& drawn) {
  const auto along = [](const FrameDescription& f, const FrameMember& m) {
    return Vector3(*find(f.nodes, m.to) - *find(f.nodes, m.from));
  };
  for (auto& [name, m] : built.members)
    if (const Vector3 before = along(drawn, m); m.y_axis.isZero(0) && along(built, m) != before)
      m.y_axis = member_axes(before, m.y_axis).col(1);
}

}  // namespace

FrameDescription moved(const FrameDescription& f, const NumberMove& move, double times) {
  FrameDescription out = f;
  for_each_number(out, [&](std::size_t i, double& x) {
    for (const auto& [index, shift] : move.shifts)
      if (index == i) x += times * shift;
  });
  if (out.nodes != f.nodes) keep_axes(out, f);
  return out;
}

void require_tolerance(const FrameDescription& f, const std::string& key, const std::string& value) {
  const std::vector<Number> all = numbers_of(f), numbers = meant(f, all, key);
  if (numbers.empty()) {
    const std::string near = nearest(key, known_keys(all));
    throw InputError(
        fmt::format("no number of this frame has this tolerance{}: a key is a kind of part and a field "
                    "('member.bending_factor', 'node.position'), or a path ('members.beam.bending_factor')",
                    near.empty() ? "" : fmt::format(", did you mean '{}'?", near)));
  }
  const double sigma = sigma_of(value, numbers.front().dimension);
  require_deviation(sigma, value, numbers.front().dimension);
  if (sigma > 0 && moves_of(numbers, value).empty())
    throw InputError(fmt::format("'{}' is a share of a number that is zero: give a unit instead", value));
}

}  // namespace deflect::frame
