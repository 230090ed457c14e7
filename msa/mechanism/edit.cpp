#include <fmt/format.h>

#include <algorithm>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/fields/field_reader.h"
#include "msa/fields/field_writer.h"
#include "msa/fields/tree_edit.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/fields.h"
#include "msa/mechanism/mechanism_tree.h"

namespace deflect {
namespace {

/// "leg[4].guideway.E" as 4 and "guideway.E".
std::pair<int, std::string> leg_and_rest(const std::string& path, const std::string& where, int legs) {
  for (int leg = 1; leg <= legs; ++leg)
    if (const std::string head = fmt::format("leg[{}].", leg); path.starts_with(head))
      return {leg, path.substr(head.size())};
  throw InputError(
      fmt::format("{}{}: one leg is written leg[1] to leg[{}], then a dot and the field", where, path, legs));
}

YamlNode variation_node(int leg, const std::string& path, YamlNode value) {
  YamlNode node, number, text;
  node.kind = YamlNode::Kind::map;
  number.kind = text.kind = YamlNode::Kind::scalar;
  number.text = std::to_string(leg);
  text.text = path;
  node.add("leg", number);
  node.add("path", text);
  node.add("value", std::move(value));
  return node;
}

/// Adds the variation and drops those of the same leg that it covers. It comes last, so that it holds.
void put(YamlNode& variations, YamlNode added) {
  const auto covered = [&](const YamlNode& old) {
    const std::string &path = old.child("path")->text, &above = added.child("path")->text;
    return old.child("leg")->text == added.child("leg")->text && (path + ".").starts_with(above + ".");
  };
  std::erase_if(variations.children, covered);
  variations.children.push_back(std::move(added));
  variations.implied = false;
}

/// A leg whose parts stand in its mount, not in the leg that the others share.
bool has_own_parts(const Mechanism& m, int leg) { return !m.mounts.empty() && !nth(m.mounts, leg - 1).leg.empty(); }

MarkedLeg marked_leg(const Mechanism& m, int leg) {
  if (leg < 1 || leg > leg_count(m))
    throw InputError(fmt::format("{}: there is no leg {}, legs are 1 to {}", m.name, leg, leg_count(m)));
  if (has_own_parts(m, leg)) return {nth(m.mounts, leg - 1).leg, {}};
  const bool varies =
      std::any_of(m.variations.begin(), m.variations.end(), [&](const auto& v) { return v.leg == leg; });
  if (!varies) return {m.leg, m.ours};
  return varied_legs(m, tree_of(m).child("variations"), m.name).at(leg);
}

void edit_one_leg(YamlNode& tree, const Mechanism& m, const Edit& edit, const YamlNode& value,
                  const std::string& where) {
  const auto [number, path] = leg_and_rest(edit.path, where, leg_count(m));
  const MarkedLeg leg = marked_leg(m, number);
  YamlNode parts = tree_of(leg.parts, leg.ours, m);
  const std::string inside = fmt::format("{}leg[{}].", where, number);
  const std::vector<TreePlace> all = places(parts, path, inside);
  for (const TreePlace& place : all) change(parts, place, edit.action, value, inside);
  for (const TreePlace& place : all)
    put(*tree.child("variations"), variation_node(number, path_of(parts, place), stripped(at(parts, place))));
}

/// "mounts.3.leg.guideway" for a leg that has parts of its own.
std::string path_in_file(const Mechanism& m, const Edit& edit) {
  if (!edit.path.starts_with("leg[")) return edit.path;
  const auto [leg, rest] = leg_and_rest(edit.path, origin_of(edit) + ": ", leg_count(m));
  return has_own_parts(m, leg) ? fmt::format("mounts.{}.leg.{}", leg - 1, rest) : edit.path;
}

/// The edit in the tree of `m`.
void apply(YamlNode& tree, const Mechanism& m, const Edit& edit) {
  const std::string path = path_in_file(m, edit);
  if (!path.starts_with("leg[")) return deflect::apply(tree, {path, edit.value, edit.action}, origin_of(edit));
  YamlNode value = parse_yaml(edit.value, origin_of(edit));
  set_line(value, 0);
  edit_one_leg(tree, m, edit, value, origin_of(edit) + ": ");
}

}  // namespace

MarkedLeg varied(const MarkedLeg& leg, const Variation& v, const YamlNode& value, const Mechanism& m,
                 const std::string& origin) {
  const std::string where = value.line > 0 ? fmt::format("{}:{}: ", origin, value.line) : origin + ": ";
  const std::string name = fmt::format("leg[{}]", v.leg), inside = fmt::format("{}{}.", where, name);
  YamlNode tree = tree_of(leg.parts, leg.ours, m);
  set_line(tree, value.line);
  for (const TreePlace& place : places(tree, v.path, inside)) change(tree, place, Edit::Action::set, value, inside);

  MarkedLeg out;
  FieldReader reader(origin, name);
  reader.surroundings = surroundings_of(m);
  NamedElements<Part> elements(out.parts);
  reader.read_entries(stripped(tree), elements);
  for (const std::string& path : reader.ours()) out.ours.insert("leg" + path.substr(name.size()));
  return out;
}

std::map<int, MarkedLeg> varied_legs(const Mechanism& m, const YamlNode* variations, const std::string& origin) {
  std::map<int, MarkedLeg> legs;
  for (std::size_t i = 0; i < m.variations.size(); ++i) {
    const Variation& v = m.variations[i];
    if (has_own_parts(m, v.leg))
      throw InputError(
          fmt::format("{}: leg {} has parts of its own: change them in mounts.{}.leg", origin, v.leg, v.leg - 1));
    MarkedLeg& leg = legs.try_emplace(v.leg, MarkedLeg{m.leg, m.ours}).first->second;
    leg = varied(leg, v, *variations->children[i].child("value"), m, origin);
  }
  return legs;
}

Named<Part> leg_parts(const Mechanism& m, int leg) {
  if (m.legs.empty()) return marked_leg(m, leg).parts;
  return m.legs.at(as_size(leg - 1));
}

Mechanism resolved(const Mechanism& m) {
  Mechanism out = m;
  for (int leg = 1; leg <= leg_count(m); ++leg) out.legs.push_back(leg_parts(m, leg));
  return out;
}

Mechanism edited(const Mechanism& m, const Edit& edit) {
  YamlNode tree = tree_of(m);
  apply(tree, m, edit);
  return mechanism_of(stripped(tree), origin_of(edit));
}

Mechanism edited_in_turn(const Mechanism& m, const std::vector<Edit>& edits) {
  YamlNode tree = tree_of(m);
  Mechanism before = m;
  bool pending = false;  // edits in the tree that `before` does not know
  std::string origins;
  for (const Edit& edit : edits) {
    // One leg is seen through the variations, which only a description knows how to apply.
    if (pending && path_in_file(before, edit).starts_with("leg[")) {
      before = mechanism_of(stripped(tree), origins);
      tree = tree_of(before);
    }
    apply(tree, before, edit);
    pending = true;
    origins = origin_of(edit);
  }
  return edits.empty() ? m : mechanism_of(stripped(tree), origins);
}

YamlNode tree_of(const Mechanism& m) {
  if (!m.legs.empty()) throw std::logic_error("a resolved mechanism is for models, not for files");
  Mechanism copy = m;
  FieldWriter writer(m.ours);
  describe(writer, copy);
  return writer.tree();
}

YamlNode tree_of(const Named<Part>& parts, const std::set<std::string>& ours, const Mechanism& m) {
  Named<Part> copy = parts;
  FieldWriter writer(ours);
  writer.surroundings = surroundings_of(m);
  describe_leg(writer, copy);
  return *writer.tree().child("leg");
}

}  // namespace deflect
