// Values of edits: YAML in which scalars can be parameters, "$name" or "$name unit".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "msa/base/spatial.h"
#include "msa/fields/yaml_tree.h"
#include "validation/effects/effect.h"

namespace deflect::effects {

/// A scalar "$name unit" taken apart; `name` is empty where the scalar is none.
struct ParameterUse {
  std::string name, unit;
};
ParameterUse parameter_use(std::string_view scalar);

/// The value with numbers in the place of parameters, 17 digits each, which know on which parameter they depend
/// (counted from `first`). Every name in it is one of the effect's.
YamlNode filled_in(const YamlNode& value, const Effect&, const VectorX& values, std::size_t first = 0);

/// The parameters that the value uses, as a mask over the effect's.
std::vector<bool> parameters_used(const YamlNode& value, const Effect&);

}  // namespace deflect::effects
