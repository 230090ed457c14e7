#include "validation/effects/effect_value.h"
#include "msa/base/index.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace deflect::effects {
namespace {

std::size_t index_of(const Effect& e, const std::string& name) {
  const auto at =
      std::find_if(e.parameters.begin(), e.parameters.end(), [&](const EffectParameter& p) { return p.name == name; });
  return as_size(at - e.parameters.begin());
}

void mark_used(const YamlNode& node, const Effect& e, std::vector<bool>& used) {
  const std::size_t i = index_of(e, parameter_use(node.text).name);
  if (node.kind == YamlNode::Kind::scalar && i < used.size()) used[i] = true;
  for (const YamlNode& child : node.children) mark_used(child, e, used);
}

}  // namespace

ParameterUse parameter_use(std::string_view text) {
  if (!text.starts_with('$')) return {};
  const auto name_end = std::find_if(text.begin() + 1, text.end(),
                                     [](unsigned char c) { return !(std::isalnum(c) || c == '_' || c == '-'); });
  std::string_view unit(name_end, as_size(text.end() - name_end));
  while (unit.starts_with(' ')) unit.remove_prefix(1);
  return {std::string(text.begin() + 1, name_end), std::string(unit)};
}

YamlNode filled_in(const YamlNode& value, const Effect& e, const VectorX& values, std::size_t first) {
  YamlNode out = value;
  const ParameterUse use = parameter_use(value.kind == YamlNode::Kind::scalar ? value.text : "");
  if (const std::size_t i = index_of(e, use.name); i < e.parameters.size()) {
    const std::string& unit = use.unit.empty() ? e.parameters[i].unit : use.unit;
    out.text = fmt::format("{}{}{}", values(as_index(i)), unit.empty() ? "" : " ", unit);
    out.quoted = false;
    if (const double x = values(as_index(i)); x != 0) out.depends = Dependence{first + i, x};
  }
  for (YamlNode& child : out.children) child = filled_in(child, e, values, first);
  return out;
}

std::vector<bool> parameters_used(const YamlNode& value, const Effect& e) {
  std::vector<bool> used(e.parameters.size());
  mark_used(value, e, used);
  return used;
}

}  // namespace deflect::effects
