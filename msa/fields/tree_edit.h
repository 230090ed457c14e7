// Edits of a tree made by FieldWriter: finding the places a path means, and changing what stands there.
#pragma once

#include <string>
#include <vector>

#include "msa/fields/edit.h"
#include "msa/fields/yaml_tree.h"

namespace deflect {

/// A place in a tree: the index of the child at each level.
using TreePlace = std::vector<std::size_t>;

/// What stands between the dots.
std::vector<std::string> segments_of(const std::string& path);

/// The places a path means, several where it holds "*". A list of laws that has one element lets its index be left
/// out. Among the entries that "*" stands for, those of another kind than the path's fields (a joint has no
/// bending_factor) are left out, as long as one entry has them. InputError, beginning with `where` and the path as
/// far as it is wrong, when there is no such field.
std::vector<TreePlace> places(const YamlNode& root, const std::string& path, const std::string& where);

/// "leg.universal_joint.tz.0.length".
std::string path_of(const YamlNode& root, const TreePlace&);

const YamlNode& at(const YamlNode& root, const TreePlace&);

/// What stands at the place after the action. Assumptions ("ours") of an enclosing value pass to the parts of it that
/// are not edited. InputError, beginning with `where`, when the action does not fit what stands there.
void change(YamlNode& root, const TreePlace&, Edit::Action, const YamlNode& value, const std::string& where);

/// An edit whose value has been parsed.
struct TreeEdit {
  std::string path;
  YamlNode value;
  Edit::Action action = Edit::Action::set;
};
/// InputError where the value is no YAML.
TreeEdit parsed(const Edit&);
std::string origin_of(const TreeEdit&);

/// An edit at every place that its path means. InputError beginning with `origin`, as origin_of() of the edit.
void apply(YamlNode& root, const TreeEdit&, const std::string& origin);

}  // namespace deflect
