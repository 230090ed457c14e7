#include "msa/base/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/number_words.h"
#include "msa/base/spatial.h"

namespace deflect {
namespace {

/// SI value = number · times / over; both are exact in binary where a unit allows, so that 125.5 mm is the double
/// nearest to 0.1255.
struct Unit {
  const char* name;
  double times;
  double over = 1;
};

struct Row {
  Dimension dimension;
  const char* words;
  std::vector<Unit> units;  // preferred first
  double largest = std::numeric_limits<double>::infinity();
};

// Inch = 0.0254 m, pound-force = 4.4482216152605 N (both exact by definition).
const double inch = 0.0254, lbf = 4.4482216152605;

const std::vector<Row>& table() {
  static const std::vector<Row> rows = {
      {Dimension::none, "a plain number", {}},
      {Dimension::ratio, "a ratio", {{"%", 1, 100}}},
      {Dimension::length,
       "a length",
       {{"mm", 1, 1e3}, {"m", 1}, {"cm", 1, 100}, {"um", 1, 1e6}, {"in", inch}, {"ft", 12 * inch}},
       largest_length},
      {Dimension::angle, "an angle", {{"deg", pi, 180}, {"rad", 1}, {"mrad", 1, 1e3}, {"urad", 1, 1e6}}},
      {Dimension::area, "an area", {{"mm^2", 1, 1e6}, {"m^2", 1}, {"in^2", inch * inch}}, 1e12},
      {Dimension::second_moment,
       "a second moment of area",
       {{"mm^4", 1, 1e12}, {"m^4", 1}, {"cm^4", 1, 1e8}, {"in^4", inch * inch * inch * inch}},
       1e24},
      {Dimension::force, "a force", {{"N", 1}, {"kN", 1e3}, {"lbf", lbf}, {"kip", lbf * 1e3}}, largest_force},
      {Dimension::moment,
       "a moment",
       {{"Nmm", 1, 1e3}, {"Nm", 1}, {"kNm", 1e3}, {"lbf*in", lbf * inch}, {"kip*in", lbf * 1e3 * inch}},
       largest_moment},
      {Dimension::stress,
       "a stress or modulus",
       {{"GPa", 1e9},
        {"MPa", 1e6},
        {"Pa", 1},
        {"N/mm^2", 1e6},
        {"psi", lbf / (inch * inch)},
        {"ksi", lbf * 1e3 / (inch * inch)}}},
      {Dimension::stiffness,
       "a stiffness (force per length)",
       {{"N/mm", 1e3},
        {"N/m", 1},
        {"kN/m", 1e3},
        {"kN/mm", 1e6},
        {"N/um", 1e6},
        {"lbf/in", lbf / inch},
        {"kip/in", lbf * 1e3 / inch}}},
      {Dimension::rotational_stiffness,
       "a rotational stiffness (moment per angle)",
       {{"Nmm/rad", 1, 1e3},
        {"Nm/rad", 1},
        {"kNm/rad", 1e3},
        {"lbf*in/rad", lbf * inch},
        {"kip*in/rad", lbf * 1e3 * inch}}},
      {Dimension::line_load,
       "a line load (force per length)",
       {{"N/mm", 1e3},
        {"N/m", 1},
        {"kN/m", 1e3},
        {"lbf/in", lbf / inch},
        {"lbf/ft", lbf / (12 * inch)},
        {"kip/in", lbf * 1e3 / inch},
        {"kip/ft", lbf * 1e3 / (12 * inch)}},
       largest_force},
      {Dimension::density, "a density", {{"kg/m^3", 1}, {"kg/mm^3", 1e9}, {"g/cm^3", 1e3}}},
      {Dimension::thermal_expansion, "a thermal expansion", {{"1/K", 1}}},
      {Dimension::temperature, "a temperature difference", {{"K", 1}}},
      {Dimension::acceleration, "an acceleration", {{"m/s^2", 1}, {"mm/s^2", 1, 1e3}, {"in/s^2", inch}}},
      {Dimension::mass, "a mass", {{"kg", 1}, {"g", 1, 1e3}, {"lb", 0.45359237}}, largest_force},
      {Dimension::compliance,
       "a compliance (length per force)",
       {{"mm/N", 1, 1e3}, {"m/N", 1}, {"um/N", 1, 1e6}, {"in/lbf", inch / lbf}}},
      {Dimension::rotational_compliance,
       "a rotational compliance (angle per moment)",
       {{"rad/Nm", 1}, {"rad/Nmm", 1e3}, {"mrad/Nm", 1, 1e3}, {"rad/(lbf*in)", 1 / (lbf * inch)}}},
      {Dimension::strain, "a strain", {{"um/m", 1, 1e6}, {"mm/m", 1, 1e3}, {"m/m", 1}}},
  };
  return rows;
}

const Row& row(Dimension d) {
  return *std::find_if(table().begin(), table().end(), [d](const Row& r) { return r.dimension == d; });
}

std::string_view trim(std::string_view s) {
  const auto from = s.find_first_not_of(" \t");
  if (from == s.npos) return {};
  return s.substr(from, s.find_last_not_of(" \t") - from + 1);
}

/// The number at the start of the text; `rest` is what follows it.
bool leading_number(std::string_view text, double& value, std::string_view& rest) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return false;
  rest = trim(text.substr(as_size(end - text.data())));
  return true;
}

/// "1e+06 m"
std::string largest_of(const Row& r) {
  const auto si =
      std::find_if(r.units.begin(), r.units.end(), [](const Unit& u) { return u.times == 1 && u.over == 1; });
  return fmt::format("{:g} {}", r.largest, si == r.units.end() ? "" : si->name);
}

double in_si(double number, const Unit& u) { return number * u.times / u.over; }

std::string unit_list(const Row& r) {
  std::string list;
  for (const Unit& u : r.units) list += (list.empty() ? "" : ", ") + std::string(u.name);
  return list;
}

/// With u for the micro sign U+00B5 and for the Greek letter U+03BC, which look alike.
std::string with_plain_micro(std::string_view unit) {
  std::string out(unit);
  for (const char* micro : {"\xC2\xB5", "\xCE\xBC"})
    for (std::size_t at; (at = out.find(micro)) != out.npos;) out.replace(at, 2, "u");
  return out;
}

}  // namespace

void require_digits_of_angle(double rad, std::string_view text) {
  if (!(std::abs(rad) <= largest_angle))
    throw InputError(
        fmt::format("'{}' is an angle of {:.3g} turns, so large that too few of its digits are left: write the same "
                    "angle within one turn",
                    text, rad / (2 * pi)));
}

void require_usable_size(double si, Dimension d, std::string_view text) {
  const Row& r = row(d);
  if (std::abs(si) > r.largest)
    throw InputError(fmt::format("'{}' is too large for {}: at most {}", text, r.words, largest_of(r)));
}

std::vector<std::string> units_of(Dimension d) {
  std::vector<std::string> names;
  for (const Unit& u : row(d).units) names.emplace_back(u.name);
  return names;
}

std::string describe(Dimension d) { return row(d).words; }

double parse_number(std::string_view text) {
  double value = 0;
  std::string_view rest;
  if (!leading_number(trim(text), value, rest) || !rest.empty())
    throw InputError(fmt::format("'{}' is not a finite number{}", text, odd_character_words(text)));
  return value;
}

double parse_quantity(std::string_view text, Dimension dimension) {
  const Row& r = row(dimension);
  double value = 0;
  std::string_view written;
  if (!leading_number(trim(text), value, written))
    throw InputError(fmt::format("'{}' is not {}: write a finite number{}{}", text, r.words,
                                 r.units.empty() ? "" : fmt::format(" and a unit, one of {}", unit_list(r)),
                                 odd_character_words(text)));
  const std::string unit = with_plain_micro(written);
  if (unit.empty()) {
    if (dimension == Dimension::none || dimension == Dimension::ratio) return value;
    throw InputError(
        fmt::format("'{}' has no unit: write {}, for example '{} {}'", text, r.words, text, r.units.front().name));
  }
  for (const Unit& u : r.units)
    if (unit == u.name) {
      const double si = in_si(value, u);
      if (!std::isfinite(si)) throw InputError(fmt::format("'{}' is too large for {}", text, r.words));
      if (dimension == Dimension::angle) require_digits_of_angle(si, text);
      return si;
    }
  if (r.units.empty()) throw InputError(fmt::format("'{}' must be a plain number without a unit", text));
  for (const Row& other : table())
    for (const Unit& u : other.units)
      if (unit == u.name)
        throw InputError(
            fmt::format("'{}' is {}, where {} is wanted (units: {})", text, other.words, r.words, unit_list(r)));
  const std::string hint = nearest(unit, units_of(dimension));
  throw InputError(fmt::format("'{}' has the unknown unit '{}'{} (units of {}: {})", text, written,
                               hint.empty() ? "" : fmt::format(", did you mean '{}'?", hint), r.words, unit_list(r)));
}

namespace {

/// The shortest number in this unit that is read back as exactly `value`; empty where rounding makes every one miss.
std::string digits_in(double value, const Unit& u) {
  const double scaled = value * u.over / u.times;
  for (int digits = 1; digits <= 17 && std::isfinite(scaled); ++digits) {
    double rounded = 0;
    std::string_view rest;
    if (leading_number(fmt::format("{:.{}g}", scaled, digits), rounded, rest) && in_si(rounded, u) == value)
      return fmt::format("{}", rounded);
  }
  return "";
}

}  // namespace

std::string format_quantity(double value, Dimension dimension) {
  constexpr std::size_t many = 12, fewer = 5, exponent = 5;  // characters
  const Row& r = row(dimension);
  if (r.units.empty() || dimension == Dimension::ratio) return fmt::format("{}", value);
  const Unit* best = &r.units.front();
  std::string text = digits_in(value, *best);
  if (!text.empty() && text.size() <= many) return fmt::format("{} {}", text, best->name);
  // "60 um" is 0.060000000000000005 mm: the unit in which it was written has few digits, and hardly another one.
  const auto length = [](const std::string& digits) {
    return digits.empty() ? std::string::npos : digits.size() + (digits.find('e') == std::string::npos ? 0 : exponent);
  };
  std::size_t least = text.empty() ? std::string::npos : text.size() - fewer;
  for (const Unit& u : r.units)
    if (std::string other = digits_in(value, u); length(other) < least)
      least = length(other), text = std::move(other), best = &u;
  if (text.empty()) text = fmt::format("{:.17g}", value * best->over / best->times);  // not finite
  return fmt::format("{} {}", text, best->name);
}

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
  constexpr std::size_t longest = 200;  // a longer word is no misspelling, and the distance would take long
  if (word.size() > longest) return "";
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 2) + 1;
  for (const std::string& candidate : known) {
    std::vector<std::size_t> previous(candidate.size() + 1), current(candidate.size() + 1);
    std::iota(previous.begin(), previous.end(), std::size_t{0});
    for (std::size_t i = 0; i < word.size(); ++i) {
      current[0] = i + 1;
      for (std::size_t j = 0; j < candidate.size(); ++j)
        current[j + 1] = std::min({previous[j + 1] + 1, current[j] + 1, previous[j] + (word[i] != candidate[j])});
      std::swap(previous, current);
    }
    if (previous.back() < best_distance) best_distance = previous.back(), best = candidate;
  }
  return best;
}

}  // namespace deflect
