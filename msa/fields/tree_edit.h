// Edits of a tree made by FieldWriter: resolves paths to places and changes the values there.
#pragma once

#include <string>
#include <vector>

#include "msa/fields/edit.h"
#include "msa/fields/yaml_tree.h"

namespace deflect {

/// A place in a tree: the index of the child at each level.
using TreePlace = std::vector<std::size_t>;

/// The path split at its dots.
std::vector<std::string> segments_of(const std::string& path);

/// The places that a path addresses; several where it contains "*". The index of a list of laws with one element may be
/// omitted. Entries matched by "*" that lack the path's fields (a joint has no bending_factor) are skipped, as long as
/// one entry has them. Throws InputError, beginning with `where` and the path up to the error, where there is no such
/// field.
std::vector<TreePlace> places(const YamlNode& root, const std::string& path, const std::string& where);

/// "leg.universal_joint.tz.0.length".
std::string path_of(const YamlNode& root, const TreePlace&);

const YamlNode& at(const YamlNode& root, const TreePlace&);

/// Applies the action to the value at a place. The mark as assumed ("ours") of an enclosing value passes to those of
/// its parts that are not edited. Throws InputError, beginning with `where`, where the action does not fit the value.
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

/// Applies an edit at every place that its path addresses. Throws InputError beginning with origin_of() of the edit.
void apply(YamlNode& root, const TreeEdit&, const std::string& origin);

}  // namespace deflect
