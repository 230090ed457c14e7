#include "msa/mechanism/questions.h"

#include <fmt/format.h>

namespace deflect {

std::optional<std::string> question_about(const std::string& name, const Material& m) {
  constexpr double plastics = 0.3e9;  // Pa: polyethylene; rubber has a tenth of it and less
  if (m.E >= plastics) return {};
  return fmt::format(
      "materials.{}.E: {:g} GPa is softer than plastics (0.3 GPa and more; metals 40 to 400 GPa): are GPa meant?", name,
      m.E / 1e9);
}

}  // namespace deflect
