#include "validation/measurement/column_names.h"

#include <fmt/format.h>

#include <algorithm>

#include "msa/base/units.h"
#include "validation/measurement/measurements.h"

namespace deflect::measurement {
namespace {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

/// "sigma_u_mm" → "sigma_u".
std::size_t unit_at(std::string_view name) {
  constexpr std::string_view strain = "_um_per_m";
  return name.ends_with(strain) ? name.size() - strain.size() : name.rfind('_');
}

std::string_view without_unit(std::string_view name) { return name.substr(0, unit_at(name)); }

std::string_view unit_of(std::string_view name) { return name.substr(unit_at(name) + 1); }

}  // namespace

std::string sensor_column(const SensorChannel& sensor) { return sensor.name + "_" + row_of(sensor.quantity).unit; }

std::string load_column(const std::string& point, std::size_t component) {
  return point + "." + load_columns.at(component);
}

bool is_misspelled(std::string_view name, const std::vector<std::string>& known) {
  const std::string word = lower_case(name);
  return std::any_of(known.begin(), known.end(), [&](const std::string& candidate) {
    const std::string right = lower_case(candidate), stem(without_unit(right));
    return word == right || (stem != right && (word == stem || without_unit(word) == stem));
  });
}

std::string unknown_column(std::string_view name, const std::vector<std::string>& known) {
  const std::string unknown = fmt::format("unknown column '{}'", excerpt(name));
  const std::string word = lower_case(name);
  for (const std::string& candidate : known)
    if (lower_case(candidate) == word) return fmt::format("{}, did you mean '{}'?", unknown, candidate);
  for (const std::string& candidate : known) {
    const std::string stem = lower_case(without_unit(candidate));
    if (stem == candidate) continue;  // has no unit
    if (stem == word) return fmt::format("{}: the unit is missing, did you mean '{}'?", unknown, candidate);
    if (stem == without_unit(word))
      return fmt::format("{}, did you mean '{}', with its numbers in {}?", unknown, candidate, unit_of(candidate));
  }
  const std::string_view beginning = without_unit(word);
  for (const std::string& candidate : known)
    if (beginning.size() > 2 && candidate.starts_with(beginning))
      return fmt::format("{}, did you mean '{}'?", unknown, candidate);
  // Far longer than any known name it is no misspelling, and the edit distance would take long.
  const std::string near = name.size() < 40 ? nearest(name, known) : "";
  if (!near.empty()) return fmt::format("{}, did you mean '{}'?", unknown, near);
  constexpr std::size_t most = 40;
  std::vector<std::string> some = known;
  if (some.size() > most) some.resize(most), some.push_back("…");
  return fmt::format("{} (columns: {}; the names of remarks begin with note)", unknown, fmt::join(some, ", "));
}

std::string excerpt(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::size_t end = std::min(text.size(), longest);
  while (end < text.size() && end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80)
    --end;  // whole letters
  std::string beginning(text.substr(0, end));
  std::replace_if(
      beginning.begin(), beginning.end(), [](char c) { return c >= 0 && c < ' '; }, ' ');
  return end < text.size() ? beginning + "…" : beginning;
}

}  // namespace deflect::measurement
