// Properties of each law that do not depend on its parameters, one row per law. The tests of all laws take their
// examples from it.
#pragma once

#include <array>
#include <iterator>

#include "msa/mechanism/law.h"

namespace deflect {

enum class Curve {
  straight,  ///< one stiffness at every load
  smooth,    ///< stiffness depends smoothly on the load
  jumps,     ///< piecewise: the relation of force and displacement switches at some load; solved by phases
};

struct LawRow {
  const char* name;   ///< in device files
  const char* along;  ///< an example on a translation, as a device file has it
  const char* about;  ///< an example on a rotation; null: only allowed on translations
  Curve curve;
  bool has_history = false;       ///< its force depends on earlier loads (conditions.h)
  bool length_from_pose = false;  ///< without a given length it is as long as the actuator's extension
};

/// In the order of the variant.
inline constexpr LawRow law_rows[] = {
    {"linear", "stiffness: 400 N/mm", "stiffness: 100 Nm/rad", Curve::straight},
    {"hertz_point", "material: steel, radius: 4 mm", nullptr, Curve::smooth},
    {"hertz_line", "material: steel, radius: 1.5 mm, length: 10 mm", nullptr, Curve::straight},
    {"pin_bending", "material: steel, diameter: 3 mm, length: 10 mm", nullptr, Curve::straight},
    {"motor_shaft", "material: steel, diameter: 6 mm, length: 50 mm, pulley_radius: 10 mm", nullptr, Curve::straight},
    {"cable", "material: steel, area: 1 mm^2, length: 80 mm", nullptr, Curve::straight, false, true},
    {"cable_pair", "material: steel, area_1: 1 mm^2, length_1: 80 mm, area_2: 2 mm^2, length_2: 300 mm", nullptr,
     Curve::straight},
    {"belt", "specific_stiffness: 2000 N/mm, width: 10 mm, tight_length: 100 mm, slack_length: 300 mm",
     "specific_stiffness: 2000 N/mm, width: 10 mm, tight_length: 100 mm, slack_length: 300 mm, pulley_radius: 20 mm",
     Curve::straight},
    {"hertz_line_bulk", "material: steel, radius_1: 3 mm, radius_2: 4 mm, length: 10 mm", nullptr, Curve::smooth},
    {"power", "deflection: 2.5 um, force: 1 N, exponent: 0.6667", "deflection: 1 mrad, moment: 1 Nm, exponent: 0.7",
     Curve::smooth},
    {"one_sided", "pull: 1e-5 mm/N, push: 0.01 mm/N", "pull: 0.01 rad/Nm, push: 0.001 rad/Nm", Curve::jumps},
    {"hardening", "stiffness: 500 N/mm, reference: 0.1 mm", "stiffness: 100 Nm/rad, reference: 0.01 rad",
     Curve::smooth},
    {"clearance", "gap: 0.02 mm", "gap: 0.1 deg", Curve::jumps},
    {"friction", "force: 1000 N, stiffness: 1e4 N/mm", "moment: 100 Nm, stiffness: 1e4 Nm/rad", Curve::jumps, true},
};
static_assert(std::size(law_rows) == std::variant_size_v<Law>, "a law without a row, or a row without a law");

inline constexpr auto law_names = [] {
  std::array<const char*, std::size(law_rows)> names{};
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = law_rows[i].name;
  return names;
}();

inline const LawRow& row_of(const Law& law) { return law_rows[law.index()]; }

/// Whether the stiffness does not depend on the force. A power law with exponent 1 is linear.
inline bool is_linear(const Law& law) {
  const auto* power = std::get_if<PowerLaw>(&law);
  return row_of(law).curve == Curve::straight || (power && power->exponent == 1);
}
inline bool jumps(const Law& law) { return row_of(law).curve == Curve::jumps; }

/// The field for the length that a law may take from the pose, empty where the file gives no length; null for a law
/// without such a field.
inline std::optional<double>* length_from_pose(Law& law) {
  auto* cable = std::get_if<CableLaw>(&law);
  return cable ? &cable->length : nullptr;
}
inline bool lacks_length(const Law& law) {
  const auto* cable = std::get_if<CableLaw>(&law);
  return cable && !cable->length;
}

}  // namespace deflect
