// Converts between a YAML tree and a whole mechanism, with all checks of a device file.
#pragma once

#include <map>
#include <set>
#include <string>

#include "msa/fields/tree_edit.h"
#include "msa/fields/yaml_tree.h"
#include "msa/mechanism/description.h"

namespace deflect {

/// A mechanism, and which of its numbers depend on parameters that were filled into its tree.
struct DependentMechanism {
  Mechanism mechanism;
  Dependences depends = {};
};

/// Reads and checks a tree as a device file. Throws InputError "origin:line: path: …".
DependentMechanism mechanism_of(const YamlNode& tree, const std::string& origin);

/// As edited_in_turn (device_file.h), for edits into which parameters were filled.
DependentMechanism edited_in_turn(DependentMechanism, const std::vector<TreeEdit>&);

/// As resolved (device_file.h); paths in legs begin "leg[3]." where each leg has numbers of its own (numbers.h).
DependentMechanism resolved(const DependentMechanism&);

/// The parts of one leg with the values among them that are assumed and those that depend on parameters
/// ("leg.guideway.bending_factor").
struct MarkedLeg {
  Named<Part> parts;
  std::set<std::string> ours;
  Dependences depends = {};
};

/// The leg with one variation applied and checked. `value` is the variation's value as a node: its tags are kept, and
/// messages contain `origin` and the node's line.
MarkedLeg varied(const MarkedLeg&, const Variation&, const YamlNode& value, const Mechanism& surroundings,
                 const std::string& origin);

/// The legs that have variations, by number. `variations` is the list in the tree that `m` was read from, `depends`
/// what depends in that tree.
std::map<int, MarkedLeg> varied_legs(const Mechanism& m, const YamlNode* variations, const std::string& origin,
                                     const Dependences& depends = {});

/// The whole description, including implied values.
YamlNode tree_of(const Mechanism&);

/// The parts of a leg as a map of entries; paths in `ours` begin with "leg.".
YamlNode tree_of(const Named<Part>&, const std::set<std::string>& ours, const Mechanism& surroundings);

}  // namespace deflect
