// Converts between a YAML tree and a whole mechanism, with all checks of a device file.
#pragma once

#include <map>
#include <set>
#include <string>

#include "msa/fields/yaml_tree.h"
#include "msa/mechanism/description.h"

namespace deflect {

/// Reads and checks a tree as a device file. Throws InputError "origin:line: path: …".
Mechanism mechanism_of(const YamlNode& tree, const std::string& origin);

/// The parts of one leg, and the paths of assumed values among them ("leg.guideway.bending_factor").
struct MarkedLeg {
  Named<Part> parts;
  std::set<std::string> ours;
};

/// The leg with one variation applied and checked. `value` is the variation's value as a node: its tags are kept, and
/// messages contain `origin` and the node's line.
MarkedLeg varied(const MarkedLeg&, const Variation&, const YamlNode& value, const Mechanism& surroundings,
                 const std::string& origin);

/// The legs that have variations, by number. `variations` is the list in the tree that `m` was read from.
std::map<int, MarkedLeg> varied_legs(const Mechanism& m, const YamlNode* variations, const std::string& origin);

/// The whole description, including implied values.
YamlNode tree_of(const Mechanism&);

/// The parts of a leg as a map of entries; paths in `ours` begin with "leg.".
YamlNode tree_of(const Named<Part>&, const std::set<std::string>& ours, const Mechanism& surroundings);

}  // namespace deflect
