// YAML as plain data, so that the library behind it stays in one file. A node knows its line for messages and
// whether it carries the tag !ours; a tree made from a description knows more (see "written" below).
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "msa/base/units.h"

namespace deflect {

/// How a number depends on a parameter that was filled in: offset + factor · x.
struct Dependence {
  std::size_t parameter = 0;
  double x = 0;                   ///< the parameter's value; not 0
  double offset = 0, factor = 1;  ///< SI; the factor is known when the number has been read
  bool alone = true;              ///< false: another parameter moves this number too
};

struct YamlNode {
  enum class Kind { null, scalar, list, map };
  Kind kind = Kind::null;
  std::string text;                ///< of a scalar
  std::vector<std::string> keys;   ///< of a map, in the order of the file: keys[i] names children[i]
  std::vector<YamlNode> children;  ///< of a map or a list
  bool ours = false;               ///< tagged !ours
  bool quoted = false;             ///< free text: written in quotes where another reader would see a number or a word
  int line = 0, key_line = 0;      ///< 1-based, 0 where there is no file: of the value, of its key
  std::optional<Dependence> depends;  ///< of a scalar that a parameter was filled into

  // Written: set by FieldWriter only.
  bool implied = false;    ///< a default or an absent field: known to edits, not part of the file
  bool entries = false;    ///< a map of named entries, not of fields
  bool collapses = false;  ///< a list that stands without its dash when it has one element
  std::optional<double> number;
  Dimension dimension = Dimension::none;

  YamlNode* child(std::string_view key);
  const YamlNode* child(std::string_view key) const { return const_cast<YamlNode*>(this)->child(key); }
  void add(std::string key, YamlNode node);
  bool empty() const { return children.empty(); }
};

/// One YAML document. InputError "origin:line: path: …" on invalid YAML, a doubled key, a key that is not a name, an
/// anchor, an alias, a tag other than !ours, control characters, invalid UTF-8, a second document.
YamlNode parse_yaml(std::string_view text, const std::string& origin);

/// Block style outside, flow style for lists of numbers and for maps of plain values below the top level.
std::string block_yaml(const YamlNode& map);

/// One line in flow style, without the node's own tag.
std::string flow_yaml(const YamlNode&);

/// Without what is implied.
YamlNode stripped(const YamlNode&);

/// By the path of the number: "leg.elbow.rz.0.stiffness".
using Dependences = std::map<std::string, Dependence>;

/// Puts the dependences at their places in a tree; paths that lead nowhere are passed over.
void attach(YamlNode& root, const Dependences&);

/// The node and all below it stand on this line.
void set_line(YamlNode&, int line);

/// "a.b", or the other where one is empty.
std::string joined(const std::string& path, std::string_view key);

/// ", did you mean 'x'? (known: …)": the end of a message about a word that is not among `known`.
std::string suggestion(std::string_view word, const std::vector<std::string>& known);

}  // namespace deflect
