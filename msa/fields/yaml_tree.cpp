#include "msa/fields/yaml_tree.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <span>

#include "msa/base/index.h"

namespace deflect {

YamlNode* YamlNode::child(std::string_view key) {
  const auto at = std::find(keys.begin(), keys.end(), key);
  return at == keys.end() ? nullptr : &nth(children, at - keys.begin());
}

void YamlNode::add(std::string key, YamlNode node) {
  keys.push_back(std::move(key));
  children.push_back(std::move(node));
}

YamlNode stripped(const YamlNode& node) {
  YamlNode out = node;
  out.keys.clear();
  out.children.clear();
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    if (node.children[i].implied) continue;
    if (node.kind == YamlNode::Kind::map) out.keys.push_back(node.keys[i]);
    out.children.push_back(stripped(node.children[i]));
  }
  return out;
}

void attach(YamlNode& root, const Dependences& all) {
  for (const auto& [path, dependence] : all) {
    YamlNode* node = &root;
    for (std::string_view rest = path; node && !rest.empty();) {
      const std::size_t dot = std::min(rest.find('.'), rest.size());
      const std::string_view segment = rest.substr(0, dot);
      rest.remove_prefix(std::min(dot + 1, rest.size()));
      if (node->kind == YamlNode::Kind::map) {
        YamlNode* const child = node->child(segment);
        if (!child && segment == "0") continue;  // a list of one entry may stand as that entry alone
        node = child;
        continue;
      }
      std::size_t i = node->children.size();
      std::from_chars(segment.data(), segment.data() + segment.size(), i);
      node = i < node->children.size() ? &node->children[i] : nullptr;
    }
    if (node) node->depends = dependence;
  }
}

void set_line(YamlNode& node, int line) {
  node.line = node.key_line = line;
  for (YamlNode& child : node.children) set_line(child, line);
}

std::string joined(const std::string& path, std::string_view key) {
  return path.empty() || key.empty() ? fmt::format("{}{}", path, key) : fmt::format("{}.{}", path, key);
}

std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
  constexpr std::size_t most = 60;
  const std::string hint = nearest(word, known);
  std::string all =
      known.empty() ? "none" : fmt::format("{}", fmt::join(std::span(known).first(std::min(most, known.size())), ", "));
  if (known.size() > most) all += fmt::format(", … and {} more", known.size() - most);
  return fmt::format("{} (known: {})", hint.empty() ? "" : fmt::format(", did you mean '{}'?", hint), all);
}

}  // namespace deflect
