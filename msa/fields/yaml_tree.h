// YAML as plain data, so that only one file uses the library. A node has its line for messages and whether it has the
// tag !ours; a tree made from a description has more (see "written" below).
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
  bool quoted = false;             ///< free text: written in quotes where a reader would take it for a number or a word
  int line = 0, key_line = 0;      ///< 1-based lines of the value and of its key; 0 without a file
  std::optional<Dependence> depends;  ///< of a scalar that a parameter was filled into

  // Written: set by FieldWriter only.
  bool implied = false;    ///< a default or an absent field: visible to edits, not written to the file
  bool entries = false;    ///< a map of named entries, not of fields
  bool collapses = false;  ///< a list that is written without brackets or dash where it has one element
  std::optional<double> number;
  Dimension dimension = Dimension::none;

  YamlNode* child(std::string_view key);
  const YamlNode* child(std::string_view key) const { return const_cast<YamlNode*>(this)->child(key); }
  void add(std::string key, YamlNode node);
  bool empty() const { return children.empty(); }
};

/// One YAML document. Throws InputError "origin:line: path: …" for invalid YAML, a repeated key, a key that is not a
/// name, an anchor, an alias, a tag other than !ours, control characters, invalid UTF-8, a second document.
YamlNode parse_yaml(std::string_view text, const std::string& origin);

/// Block style outside, flow style for lists of numbers and for maps of plain values below the top level.
std::string block_yaml(const YamlNode& map);

/// One line in flow style, without the tag of the node itself.
std::string flow_yaml(const YamlNode&);

/// A copy without implied nodes.
YamlNode stripped(const YamlNode&);

/// By the path of the number: "leg.elbow.rz.0.stiffness".
using Dependences = std::map<std::string, Dependence>;

/// Puts the dependences at their places in a tree; paths that lead nowhere are passed over.
void attach(YamlNode& root, const Dependences&);

/// Sets the line of the node and of all nodes below it.
void set_line(YamlNode&, int line);

/// "a.b"; where one is empty, the other.
std::string joined(const std::string& path, std::string_view key);

/// ", did you mean 'x'? (known: …)": the end of a message about a word that is not in `known`.
std::string suggestion(std::string_view word, const std::vector<std::string>& known);

}  // namespace deflect
