#include "validation/measurement/column_units.h"

#include <algorithm>
#include <numbers>
#include <tuple>
#include <vector>

#include "validation/measurement/column_names.h"

namespace deflect::measurement {
namespace {

struct ColumnUnit {
  std::string_view name;
  double factor = 1, offset = 0;
};

constexpr double kgf_N = 9.80665, lbf_N = 4.4482216152605, deg_rad = std::numbers::pi / 180;

// The first of each is the contract's.
const std::vector<ColumnUnit> force_units = {{"N"},          {"mN", 1e-3},  {"daN", 10},          {"kN", 1e3},
                                             {"kgf", kgf_N}, {"kp", kgf_N}, {"gf", kgf_N / 1000}, {"lbf", lbf_N}};
const std::vector<ColumnUnit> moment_units = {{"Nmm"},
                                              {"Ncm", 10},
                                              {"Nm", 1e3},
                                              {"kNm", 1e6},
                                              {"kgfmm", kgf_N},
                                              {"kgfcm", 10 * kgf_N},
                                              {"kgfm", 1e3 * kgf_N},
                                              {"lbfin", 25.4 * lbf_N},
                                              {"lbfft", 304.8 * lbf_N}};
const std::vector<ColumnUnit> length_units = {{"mm"},      {"nm", 1e-6}, {"um", 1e-3},   {"µm", 1e-3},   {"cm", 10},
                                              {"m", 1000}, {"in", 25.4}, {"inch", 25.4}, {"mil", 0.0254}};
const std::vector<ColumnUnit> degree_units = {
    {"deg"}, {"°"}, {"rad", 1 / deg_rad}, {"mrad", 1e-3 / deg_rad}, {"urad", 1e-6 / deg_rad}, {"µrad", 1e-6 / deg_rad}};
const std::vector<ColumnUnit> radian_units = {{"rad"},        {"deg", deg_rad}, {"°", deg_rad},
                                              {"mrad", 1e-3}, {"urad", 1e-6},   {"µrad", 1e-6}};
const std::vector<ColumnUnit> strain_units = {{"um_per_m"},      {"µm/m"},      {"um/m"},   {"ustrain"}, {"µε"},
                                              {"mm_per_m", 1e3}, {"mm/m", 1e3}, {"1", 1e6}, {"%", 1e4}};
const std::vector<ColumnUnit> temperature_units = {{"C"}, {"°C"}, {"K", 1, -273.15}, {"F", 5.0 / 9, -32}};

std::string in_lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// The Greek letter U+03BC looks like the micro sign U+00B5.
std::string with_micro_sign(std::string_view text) {
  std::string out(text);
  for (std::size_t at; (at = out.find("\xCE\xBC")) != out.npos;) out.replace(at, 2, "\xC2\xB5");
  return out;
}

/// As it stands; else without regard to case where only one unit is meant.
const ColumnUnit* find_unit(const std::vector<ColumnUnit>& units, std::string_view written) {
  const std::string text = with_micro_sign(written);
  for (const ColumnUnit& u : units)
    if (u.name == text) return &u;
  const ColumnUnit* found = nullptr;
  for (const ColumnUnit& u : units)
    if (u.name != "mN" && in_lower_case(u.name) == in_lower_case(text)) {  // MN would be another unit
      if (found) return nullptr;
      found = &u;
    }
  return found;
}

std::string_view without_brackets(std::string_view text) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, {'(', ')'}})
    if (text.size() > 1 && text.front() == open && text.back() == close) return text.substr(1, text.size() - 2);
  return text;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// "Fx [kgf]", "fx_kgf", "fx" → stem in lower case and unit, which may be empty.
std::pair<std::string, std::string_view> stem_and_unit(std::string_view written) {
  const std::size_t bracket = written.find_first_of("[(");
  if (bracket != written.npos && bracket > 0) {
    const std::string_view stem = trimmed(written.substr(0, bracket));
    return {in_lower_case(stem.ends_with('_') ? stem.substr(0, stem.size() - 1) : stem),
            trimmed(without_brackets(trimmed(written.substr(bracket))))};
  }
  const std::string lower = in_lower_case(written);
  for (const char* stem : {"sigma_u", "sigma_th"})
    if (lower == stem) return {lower, {}};
  std::size_t at = written.rfind('_');
  if (at == written.npos) return {lower, {}};
  for (const std::string_view strain : {"_um_per_m", "_mm_per_m"})
    if (lower.ends_with(strain)) at = written.size() - strain.size();
  return {lower.substr(0, at), written.substr(at + 1)};
}

bool is_joint(std::string_view stem) {
  return stem.size() > 1 && stem.size() < 6 && stem.front() == 'q' && stem[1] != '0' &&
         std::all_of(stem.begin() + 1, stem.end(), [](char c) { return c >= '0' && c <= '9'; });
}

const std::vector<ColumnUnit>* units_of(Quantity q) {
  switch (q) {
    case Quantity::length:
      return &length_units;
    case Quantity::angle:
      return &radian_units;
    case Quantity::force:
      return &force_units;
    case Quantity::moment:
      return &moment_units;
    case Quantity::strain:
      return &strain_units;
  }
  return nullptr;
}

/// The same of an instrument's column: "probe", "handle.fx". Names that differ by upper and lower case alone are told
/// apart where they are written as they are.
std::pair<const std::vector<ColumnUnit>*, std::string> units_of(const std::string& stem, std::string_view written,
                                                                const Instruments& known) {
  for (const bool exactly : {true, false}) {
    const auto is = [&](const std::string& name) {
      return exactly ? written.substr(0, stem.size()) == name && stem.size() == name.size()
                     : stem == in_lower_case(name);
    };
    for (const SensorChannel& sensor : known.sensors)
      if (is(sensor.name)) return {units_of(sensor.quantity), sensor_column(sensor)};
    for (const std::string& point : known.load_points)
      for (std::size_t i = 0; i < 6; ++i)
        if (const std::string name = load_column(point, i); is(name.substr(0, name.rfind('_'))))
          return {i < 3 ? &force_units : &moment_units, name};
  }
  return {nullptr, ""};
}

/// The load case of a column "load.snow".
std::optional<std::string> load_case_of(std::string_view written, const Instruments& known) {
  for (const bool exactly : {true, false})
    for (const std::string& load_case : known.load_cases)
      if (const std::string name = "load." + load_case;
          exactly ? written == name : in_lower_case(written) == in_lower_case(name))
        return name;
  return std::nullopt;
}

/// The units of a stem, and the name that goes with the first of them.
std::pair<const std::vector<ColumnUnit>*, std::string> units_of(const std::string& stem) {
  const auto named = [&](const SixNames& names, std::size_t from, std::size_t to) -> std::string {
    for (std::size_t i = from; i < to; ++i)
      if (names[i].substr(0, names[i].rfind('_')) == stem) return names[i];
    return "";
  };
  for (const auto& [names, first, second] : {std::tuple{&pose_columns, &length_units, &degree_units},
                                             {&load_columns, &force_units, &moment_units},
                                             {&displacement_columns, &length_units, &radian_units}}) {
    if (const std::string name = named(*names, 0, 3); !name.empty()) return {first, name};
    if (const std::string name = named(*names, 3, 6); !name.empty()) return {second, name};
  }
  if (stem == "sigma_u") return {&length_units, "sigma_u_mm"};
  if (stem == "sigma_th") return {&radian_units, "sigma_th_rad"};
  if (stem == "temperature") return {&temperature_units, "temperature_C"};
  return {nullptr, ""};
}

}  // namespace

std::optional<NamedColumn> named_column(std::string_view written, std::string_view unit, const Instruments& known) {
  const std::string lower = in_lower_case(written);
  for (const char* name : {"pose", "sequence"})
    if (lower == name) return NamedColumn{name, ""};
  if (is_note(lower)) return NamedColumn{lower, ""};
  if (auto load_case = load_case_of(written, known)) return NamedColumn{std::move(*load_case), ""};
  auto [stem, own] = stem_and_unit(written);
  unit = trimmed(without_brackets(trimmed(unit)));
  if (unit == "-") unit = {};
  if (own.empty()) own = unit;
  if (own.empty()) return std::nullopt;
  std::string name;
  const ColumnUnit* found = nullptr;
  const std::vector<ColumnUnit>* units = nullptr;
  std::tie(units, name) = units_of(stem, written, known);
  if (units) {
    // An instrument's name comes first: a sensor may be called q1.
  } else if (is_joint(stem)) {
    units = find_unit(radian_units, own) ? &radian_units : &length_units;
    name = stem + (units == &radian_units ? "_rad" : "_mm");
  } else {
    std::tie(units, name) = units_of(stem);
  }
  if (!units || !(found = find_unit(*units, own))) return std::nullopt;
  if (!unit.empty()) {
    const ColumnUnit* below = find_unit(*units, unit);
    if (!below || below->factor != found->factor || below->offset != found->offset) return std::nullopt;
  }
  NamedColumn out{name, "", found->factor, found->offset};
  if (!out.as_it_stands()) out.unit = found->name;
  return out;
}

bool is_unit(std::string_view text) {
  text = trimmed(without_brackets(trimmed(text)));
  if (text.empty() || text == "-" || text == "1") return true;
  for (const auto* units :
       {&force_units, &moment_units, &length_units, &degree_units, &radian_units, &strain_units, &temperature_units})
    if (find_unit(*units, text)) return true;
  return false;
}

}  // namespace deflect::measurement
