// What a diagnosis found, read from the JSON of `deflect diagnose --json`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "validation/effects/with_effect.h"

namespace deflect::diagnosis {

struct FoundEffect {
  std::string effect;
  std::optional<int> leg;  ///< from "leg": 4; where there is none from "site": "leg 4"
  std::vector<std::pair<std::string, double>> parameters;
};

struct FoundEffects {
  std::vector<FoundEffect>
      missing;  ///< in the order in which they were added; values of "found", else of the best candidate
  std::vector<FoundEffect> candidates;  ///< every hypothesis, best first
};

/// InputError naming the file and the member that is not as the contract says.
FoundEffects read_found_effects(const std::filesystem::path&);

/// The same from the text of a file that messages call `origin`.
FoundEffects parse_found_effects(const std::string& json, const std::string& origin);

/// The effect with the values found. InputError for a parameter that it does not have, one without a value, and a value
/// out of its bounds.
effects::EffectInstance instance(const effects::Effect&, const FoundEffect&);

}  // namespace deflect::diagnosis
