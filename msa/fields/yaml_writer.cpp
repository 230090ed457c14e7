#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "msa/base/index.h"
#include "msa/fields/yaml_tree.h"

namespace deflect {
namespace {

using Kind = YamlNode::Kind;

bool one_of(char c, std::string_view set) { return set.find(c) != set.npos; }

/// A YAML word for true, false or null in one of its versions.
bool reserved(std::string_view text) {
  static const std::array<std::string_view, 11> words = {"true", "false", "yes", "no",   "on", "off",
                                                         "null", "y",     "n",   "none", "nan"};
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::find(words.begin(), words.end(), lower) != words.end();
}

/// Would be read back as the same text, in block and in flow style.
bool plain_safe(std::string_view text) {
  if (text.empty() || text.front() == ' ' || text.back() == ' ') return false;
  if (one_of(text.front(), ",?!&*|>'\"%@`~=<") || (text.front() == '-' && text.size() == 1)) return false;
  if (text == "null" || text == "Null" || text == "NULL" || text.starts_with("- ") || text.starts_with("---") ||
      text.starts_with("..."))
    return false;
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c < 0x7f && !one_of(c, ":#[]{}\\"); });
}

/// Free text that YAML's other readers could take for a number, a date or a truth value.
bool ambiguous(std::string_view text) {
  if (reserved(text)) return true;
  if (std::isalpha(static_cast<unsigned char>(text.front()))) return false;
  return std::none_of(text.begin(), text.end(), [](char c) {
    return std::isalpha(static_cast<unsigned char>(c)) && !one_of(c, "abcdefxoABCDEFXO");
  });
}

std::string quotation(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += fmt::format("\\{}", c);
    else if (c == '\n')
      out += "\\n";
    else if (c == '\t')
      out += "\\t";
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\x{:02x}", c);
    else
      out += c;
  }
  return out + "\"";
}

/// Plain text in flow style ends at a comma, and in yaml-cpp at a question mark.
bool ends_in_flow(std::string_view text) { return text.find_first_of(",?") != text.npos; }

std::string scalar(const YamlNode& node, bool in_flow) {
  const std::string& text = node.text;
  const bool plain = plain_safe(text) && !(in_flow && ends_in_flow(text)) && !(node.quoted && ambiguous(text));
  return plain ? text : quotation(text);
}

const YamlNode& shown(const YamlNode& node) {
  return node.collapses && node.children.size() == 1 && !node.ours ? node.children[0] : node;
}

std::string tag(const YamlNode& node) { return node.ours ? "!ours " : ""; }

std::string key_text(const std::string& key) { return plain_safe(key) && !ends_in_flow(key) ? key : quotation(key); }

bool leaf(const YamlNode& node) {
  if (node.kind == Kind::map) return false;
  return node.kind != Kind::list || std::all_of(node.children.begin(), node.children.end(),
                                                [](const YamlNode& c) { return c.kind == Kind::scalar; });
}

void block(std::string& out, const YamlNode& map, int depth) {
  const std::string margin(as_size(2 * depth), ' ');
  for (std::size_t i = 0; i < map.children.size(); ++i) {
    const YamlNode& node = shown(map.children[i]);
    const bool leaves = std::all_of(node.children.begin(), node.children.end(), leaf);
    const bool nested = !node.empty() && !leaf(node);
    if (depth == 0 && nested) out += "\n";
    out += fmt::format("{}{}:", margin, key_text(map.keys[i]));
    if (!nested || (depth > 0 && node.kind == Kind::map && leaves)) {
      out += fmt::format(" {}{}\n", tag(node),
                         leaf(node) && node.kind == Kind::scalar ? scalar(node, false) : flow_yaml(node));
    } else if (node.kind == Kind::map) {
      out += node.ours ? " !ours\n" : "\n";
      block(out, node, depth + 1);
    } else {
      out += node.ours ? " !ours\n" : "\n";
      for (const YamlNode& item : node.children) out += fmt::format("{}  - {}{}\n", margin, tag(item), flow_yaml(item));
    }
  }
}

}  // namespace

std::string block_yaml(const YamlNode& map) {
  std::string out;
  block(out, map, 0);
  return out;
}

std::string flow_yaml(const YamlNode& whole) {
  const YamlNode& node = shown(whole);
  if (node.kind == Kind::null) return "~";
  if (node.kind == Kind::scalar) return scalar(node, true);
  std::string out;
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    const YamlNode& child = node.children[i];
    if (i > 0) out += ", ";
    if (node.kind == Kind::map) out += key_text(node.keys[i]) + ": ";
    out += tag(shown(child)) + flow_yaml(child);
  }
  return node.kind == Kind::map ? "{" + out + "}" : "[" + out + "]";
}

}  // namespace deflect
