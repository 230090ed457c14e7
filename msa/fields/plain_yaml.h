// A fast parser for a simple subset of YAML, a hundred times faster than the library. Long frame files use this subset.
#pragma once

#include <optional>
#include <string_view>

#include "msa/fields/yaml_tree.h"

namespace deflect {

/// Parses block maps of one-line values (plain words and numbers, and flow maps and lists of these) with comments on
/// separate lines. Gives the same tree as the library. Nullopt for any other text, valid or not: quotes, tags, anchors,
/// block lists, values over several lines, repeated keys, other comments, tabs, characters beyond ASCII outside
/// comments, empty values.
std::optional<YamlNode> parse_plain_yaml(std::string_view text);

/// parse_yaml() by the library, for any text whose characters have been checked already.
YamlNode parse_any_yaml(std::string_view text, const std::string& origin);

}  // namespace deflect
