// Warnings about values that are valid but probably not intended.
#pragma once

#include <optional>
#include <string>

#include "msa/mechanism/law.h"

namespace deflect {

/// A sentence where a material is so soft that its unit is probably wrong: "materials.al.E: 0.07 GPa is …".
std::optional<std::string> question_about(const std::string& name, const Material&);

}  // namespace deflect
