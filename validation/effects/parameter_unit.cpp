#include "validation/effects/parameter_unit.h"
#include "msa/base/index.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace deflect::effects {
namespace {

struct Suffix {
  std::string_view name, unit, printed;
};

constexpr std::array suffixes = {
    Suffix{"mm_per_N23", "", "mm/N^(2/3)"},
    Suffix{"Nmm_per_rad", "Nmm/rad", "Nmm/rad"},
    Suffix{"Nm_per_rad", "Nm/rad", "Nm/rad"},
    Suffix{"N_per_mm", "N/mm", "N/mm"},
    Suffix{"N_per_m", "N/m", "N/m"},
    Suffix{"mm_per_N", "mm/N", "mm/N"},
    Suffix{"rad_per_Nmm", "rad/Nmm", "rad/Nmm"},
    Suffix{"rad_per_Nm", "rad/Nm", "rad/Nm"},
    Suffix{"per_K", "1/K", "1/K"},
    Suffix{"um_per_m", "um/m", "µm/m"},
    Suffix{"mm2", "mm^2", "mm^2"},
    Suffix{"mm4", "mm^4", "mm^4"},
    Suffix{"Nmm", "Nmm", "Nmm"},
    Suffix{"Nm", "Nm", "Nm"},
    Suffix{"N", "N", "N"},
    Suffix{"mm", "mm", "mm"},
    Suffix{"um", "um", "um"},
    Suffix{"m", "m", "m"},
    Suffix{"rad", "rad", "rad"},
    Suffix{"deg", "deg", "deg"},
    Suffix{"GPa", "GPa", "GPa"},
    Suffix{"MPa", "MPa", "MPa"},
    Suffix{"kg", "kg", "kg"},
    Suffix{"K", "K", "K"},
};

const Suffix* suffix_of(const std::string& name) {
  const auto at = std::find_if(suffixes.begin(), suffixes.end(), [&](const Suffix& s) {
    return name.size() > s.name.size() && name.ends_with(s.name) && name[name.size() - s.name.size() - 1] == '_';
  });
  return at == suffixes.end() ? nullptr : &*at;
}

bool part_of_unit(std::string_view word) {
  if (word == "per") return true;
  for (const Suffix& s : suffixes)
    for (std::size_t from = 0; from <= s.name.size();) {
      const std::size_t to = std::min(s.name.find('_', from), s.name.size());
      if (s.name.substr(from, to - from) == word) return true;
      from = to + 1;
    }
  return false;
}

/// All words behind the first '_' that look like units are in `name` ("stiffness_N_mm": two).
std::size_t unit_words(std::string_view name) {
  std::size_t count = 0;
  for (std::size_t at = name.rfind('_'); at != name.npos && part_of_unit(name.substr(at + 1)); at = name.rfind('_')) {
    ++count;
    name = name.substr(0, at);
  }
  return count;
}

std::size_t words(std::string_view name) { return 1 + as_size(std::count(name.begin(), name.end(), '_')); }

}  // namespace

std::optional<std::string> unit_of_parameter(const std::string& name) {
  const Suffix* suffix = suffix_of(name);
  const std::size_t known = suffix ? words(suffix->name) : 0;
  if (unit_words(name) != known) return std::nullopt;
  return std::string(suffix ? suffix->unit : "");
}

std::string printed_unit(const std::string& name) {
  const Suffix* suffix = suffix_of(name);
  return std::string(suffix ? suffix->printed : "");
}

std::string known_parameter_units() {
  std::string out;
  for (const Suffix& s : suffixes) out += (out.empty() ? "" : ", ") + std::string(s.name);
  return out;
}

}  // namespace deflect::effects
