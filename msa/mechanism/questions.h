// Warnings about values that are valid but probably not intended.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>

#include "msa/mechanism/law.h"

namespace deflect {

/// A sentence where a material is so soft that its unit is probably wrong: "materials.al.E: 0.07 GPa is …".
inline std::optional<std::string> question_about(const std::string& name, const Material& m) {
  constexpr double plastics = 0.3e9;  // Pa: polyethylene; rubber has a tenth of it and less
  if (m.E >= plastics) return {};
  return fmt::format(
      "materials.{}.E: {:g} GPa is softer than plastics (0.3 GPa and more; metals 40 to 400 GPa): are GPa meant?", name,
      m.E / 1e9);
}

}  // namespace deflect
