#include "msa/fields/field_examples.h"

#include <fmt/format.h>

namespace deflect {

const char* example_of(Dimension d) {
  switch (d) {
    case Dimension::none:
      return "0.3";
    case Dimension::ratio:
      return "1 %";
    case Dimension::length:
      return "10 mm";
    case Dimension::angle:
      return "20 deg";
    case Dimension::area:
      return "20 mm^2";
    case Dimension::second_moment:
      return "200 mm^4";
    case Dimension::force:
      return "10 N";
    case Dimension::moment:
      return "100 Nmm";
    case Dimension::stress:
      return "210 GPa";
    case Dimension::stiffness:
      return "500 N/mm";
    case Dimension::rotational_stiffness:
      return "100000 Nmm/rad";
    case Dimension::line_load:
      return "2 N/mm";
    case Dimension::density:
      return "7850 kg/m^3";
    case Dimension::thermal_expansion:
      return "12e-6 1/K";
    case Dimension::temperature:
      return "20 K";
    case Dimension::acceleration:
      return "9.81 m/s^2";
    case Dimension::compliance:
      return "0.001 mm/N";
    case Dimension::rotational_compliance:
      return "0.01 rad/Nm";
    case Dimension::strain:
      return "100 um/m";
    case Dimension::mass:
      return "2 kg";
  }
  return "";
}

std::string example_of(std::string_view key, const std::string& value) {
  return key.empty() ? value : fmt::format("{}: {}", key, value);
}

}  // namespace deflect
