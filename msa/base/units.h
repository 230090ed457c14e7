// Conversion of units on input and output, such as "125.5 mm". All other code uses SI (m, N, Pa, rad, kg, K).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace deflect {

enum class Dimension {
  none,                   ///< a plain number
  ratio,                  ///< a plain number or "1 %"
  length,                 ///< m
  angle,                  ///< rad
  area,                   ///< m²
  second_moment,          ///< m⁴
  force,                  ///< N
  moment,                 ///< Nm
  stress,                 ///< Pa
  stiffness,              ///< N/m
  rotational_stiffness,   ///< Nm/rad
  line_load,              ///< N/m
  density,                ///< kg/m³
  thermal_expansion,      ///< 1/K
  temperature,            ///< K, a difference
  acceleration,           ///< m/s²
  mass,                   ///< kg
  compliance,             ///< m/N
  rotational_compliance,  ///< rad/(Nm)
  strain,                 ///< 1
};

/// Units accepted for a dimension, the preferred one first: {"mm", "m", "um", "in"}.
std::vector<std::string> units_of(Dimension);

/// "a length", "a stiffness (force per length)", for messages.
std::string describe(Dimension);

/// The value in SI of "125.5 mm". Throws InputError with the text and the allowed units: for a missing, unknown or
/// misplaced unit, for a number that is not finite, for trailing text. µ is read as u.
double parse_quantity(std::string_view text, Dimension);

/// Largest angle, rad: above it the last binary digit is worth more than 1e-10 rad, too coarse.
inline constexpr double largest_angle = 1e6;

/// Largest values allowed in models: m, N and Nm. The last binary digit of the largest length is worth 0.1 nm. Areas,
/// second moments of area, line loads and masses have limits of the same kind.
inline constexpr double largest_length = 1e6, largest_force = 1e15, largest_moment = 1e18;

/// Throws InputError where the SI value of `text` is larger than allowed.
void require_usable_size(double si, Dimension, std::string_view text);

/// Throws InputError where the angle of `text` is larger than largest_angle; parse_quantity() checks this itself.
void require_digits_of_angle(double rad, std::string_view text);

/// The shortest text that parse_quantity() reads as exactly `value`: in the preferred unit or, if that is long, in any.
std::string format_quantity(double value, Dimension);

/// The whole text as a finite decimal number. Throws InputError where it is none.
double parse_number(std::string_view text);

/// The member of `known` with the smallest edit distance to `word`, or "" when none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

}  // namespace deflect
