// The plain part of YAML, read without a library at a hundred times the speed: long frame files are made of it.
#pragma once

#include <optional>
#include <string_view>

#include "msa/fields/yaml_tree.h"

namespace deflect {

/// Block maps of one-line values: plain words and numbers, and flow maps and lists of these; comments on lines of their
/// own. Of such a text the same tree as parse_yaml's library makes. Nothing for any other text, valid or not:
/// quotations, tags, anchors, block lists, values over several lines, doubled keys, other comments, tabs, characters
/// beyond ASCII outside comments, empty values.
std::optional<YamlNode> parse_plain_yaml(std::string_view text);

/// The same by the library, whatever the text: parse_yaml without the short way. Its characters have been checked.
YamlNode parse_any_yaml(std::string_view text, const std::string& origin);

}  // namespace deflect
