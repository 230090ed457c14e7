// Values of edits: YAML whose scalars can refer to parameters, "$name" or "$name unit".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "msa/base/spatial.h"
#include "msa/fields/yaml_tree.h"
#include "validation/effects/effect.h"

namespace deflect::effects {

/// A scalar "$name unit", split; `name` is empty where the scalar does not refer to a parameter.
struct ParameterUse {
  std::string name, unit;
};
ParameterUse parameter_use(std::string_view scalar);

/// The value with parameters replaced by numbers of 17 digits, which know on which parameter they depend (counted from
/// `first`). Every name in it must be a parameter of the effect.
YamlNode filled_in(const YamlNode& value, const Effect&, const VectorX& values, std::size_t first = 0);

/// Which of the effect's parameters the value uses, as a mask.
std::vector<bool> parameters_used(const YamlNode& value, const Effect&);

}  // namespace deflect::effects
