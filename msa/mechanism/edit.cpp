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

/// Those of the leg that all legs share.
Dependences in_every_leg(const Dependences& all) {
  Dependences out;
  for (const auto& [path, dependence] : all)
    if (path.starts_with("leg.")) out.insert({path, dependence});
  return out;
}

/// Of one leg, as "leg.…".
Dependences in_own_leg(const Dependences& all, int leg) {
  const std::string head = fmt::format("mounts.{}.", leg - 1);
  Dependences out;
  for (const auto& [path, dependence] : all)
    if (path.starts_with(head + "leg.")) out.insert({path.substr(head.size()), dependence});
  return out;
}

YamlNode tree_of(const DependentMechanism& d) {
  YamlNode tree = tree_of(d.mechanism);
  attach(tree, d.depends);
  return tree;
}

MarkedLeg marked_leg(const DependentMechanism& d, int leg) {
  const Mechanism& m = d.mechanism;
  if (leg < 1 || leg > leg_count(m))
    throw InputError(fmt::format("{}: there is no leg {}, legs are 1 to {}", m.name, leg, leg_count(m)));
  if (has_own_parts(m, leg)) return {nth(m.mounts, leg - 1).leg, {}, in_own_leg(d.depends, leg)};
  const bool varies =
      std::any_of(m.variations.begin(), m.variations.end(), [&](const auto& v) { return v.leg == leg; });
  if (!varies) return {m.leg, m.ours, in_every_leg(d.depends)};
  return varied_legs(m, tree_of(d).child("variations"), m.name, d.depends).at(leg);
}

YamlNode tree_of(const MarkedLeg& leg, const Mechanism& m) {
  YamlNode parts = tree_of(leg.parts, leg.ours, m), root;
  if (leg.depends.empty()) return parts;
  root.kind = YamlNode::Kind::map;
  root.add("leg", std::move(parts));
  attach(root, leg.depends);
  return *root.child("leg");
}

void edit_one_leg(YamlNode& tree, const DependentMechanism& d, const TreeEdit& edit, const std::string& where) {
  const Mechanism& m = d.mechanism;
  const auto [number, path] = leg_and_rest(edit.path, where, leg_count(m));
  YamlNode parts = tree_of(marked_leg(d, number), m);
  const std::string inside = fmt::format("{}leg[{}].", where, number);
  const std::vector<TreePlace> all = places(parts, path, inside);
  for (const TreePlace& place : all) change(parts, place, edit.action, edit.value, inside);
  for (const TreePlace& place : all)
    put(*tree.child("variations"), variation_node(number, path_of(parts, place), stripped(at(parts, place))));
}

/// "mounts.3.leg.guideway" for a leg that has parts of its own.
std::string path_in_file(const Mechanism& m, const TreeEdit& edit) {
  if (!edit.path.starts_with("leg[")) return edit.path;
  const auto [leg, rest] = leg_and_rest(edit.path, origin_of(edit) + ": ", leg_count(m));
  return has_own_parts(m, leg) ? fmt::format("mounts.{}.leg.{}", leg - 1, rest) : edit.path;
}

/// The edit in the tree of `m`.
void apply(YamlNode& tree, const DependentMechanism& m, const TreeEdit& edit) {
  const std::string path = path_in_file(m.mechanism, edit);
  if (!path.starts_with("leg[")) return deflect::apply(tree, {path, edit.value, edit.action}, origin_of(edit));
  edit_one_leg(tree, m, edit, origin_of(edit) + ": ");
}

}  // namespace

MarkedLeg varied(const MarkedLeg& leg, const Variation& v, const YamlNode& value, const Mechanism& m,
                 const std::string& origin) {
  const std::string where = value.line > 0 ? fmt::format("{}:{}: ", origin, value.line) : origin + ": ";
  const std::string name = fmt::format("leg[{}]", v.leg), inside = fmt::format("{}{}.", where, name);
  YamlNode tree = tree_of(leg, m);
  set_line(tree, value.line);
  for (const TreePlace& place : places(tree, v.path, inside)) change(tree, place, Edit::Action::set, value, inside);

  MarkedLeg out;
  FieldReader reader(origin, name);
  reader.surroundings = surroundings_of(m);
  NamedElements<Part> elements(out.parts);
  reader.read_entries(stripped(tree), elements);
  for (const std::string& path : reader.ours()) out.ours.insert("leg" + path.substr(name.size()));
  for (const auto& [path, dependence] : reader.depends()) out.depends["leg" + path.substr(name.size())] = dependence;
  return out;
}

std::map<int, MarkedLeg> varied_legs(const Mechanism& m, const YamlNode* variations, const std::string& origin,
                                     const Dependences& depends) {
  std::map<int, MarkedLeg> legs;
  for (std::size_t i = 0; i < m.variations.size(); ++i) {
    const Variation& v = m.variations[i];
    if (has_own_parts(m, v.leg))
      throw InputError(
          fmt::format("{}: leg {} has parts of its own: change them in mounts.{}.leg", origin, v.leg, v.leg - 1));
    MarkedLeg& leg = legs.try_emplace(v.leg, MarkedLeg{m.leg, m.ours, in_every_leg(depends)}).first->second;
    leg = varied(leg, v, *variations->children[i].child("value"), m, origin);
  }
  return legs;
}

Named<Part> leg_parts(const Mechanism& m, int leg) {
  if (m.legs.empty()) return marked_leg({m}, leg).parts;
  return m.legs.at(as_size(leg - 1));
}

Mechanism resolved(const Mechanism& m) {
  if (!m.legs.empty()) return m;
  Mechanism out = m;
  for (int leg = 1; leg <= leg_count(m); ++leg) out.legs.push_back(leg_parts(m, leg));
  return out;
}

DependentMechanism resolved(const DependentMechanism& d) {
  if (!d.mechanism.legs.empty()) return d;
  DependentMechanism out = d;
  for (int leg = 1; leg <= leg_count(d.mechanism); ++leg) {
    MarkedLeg marked = marked_leg(d, leg);
    out.mechanism.legs.push_back(std::move(marked.parts));
    for (const auto& [path, dependence] : marked.depends)
      out.depends[fmt::format("leg[{}]{}", leg, path.substr(3))] = dependence;
  }
  return out;
}

Mechanism edited(const Mechanism& m, const Edit& edit) { return edited_in_turn(m, {edit}); }

Mechanism edited_in_turn(const Mechanism& m, const std::vector<Edit>& edits) {
  std::vector<TreeEdit> all;
  for (const Edit& edit : edits) all.push_back(parsed(edit));
  return edited_in_turn({m}, all).mechanism;
}

DependentMechanism edited_in_turn(DependentMechanism before, const std::vector<TreeEdit>& edits) {
  if (edits.empty()) return before;
  YamlNode tree = tree_of(before);
  bool pending = false;  // edits in the tree that `before` does not know
  std::string origins;
  for (const TreeEdit& edit : edits) {
    // One leg is seen through the variations, which only a description knows how to apply.
    if (pending && path_in_file(before.mechanism, edit).starts_with("leg[")) {
      before = mechanism_of(stripped(tree), origins);
      tree = tree_of(before);
    }
    apply(tree, before, edit);
    pending = true;
    origins = origin_of(edit);
  }
  return mechanism_of(stripped(tree), origins);
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
