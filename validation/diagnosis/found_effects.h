// What a diagnosis found, read from the JSON of `deflect diagnose --json`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace deflect {

struct FoundEffect {
  std::string effect;
  std::optional<int> leg;  ///< from "site": "leg 4"
  std::vector<std::pair<std::string, double>> parameters;
};

struct FoundEffects {
  std::vector<FoundEffect>
      missing;  ///< in the order in which they were added; values of "found", else of the best candidate
  std::vector<FoundEffect> candidates;  ///< every hypothesis, best first
};

/// InputError naming the file and the member that is not as the contract says.
FoundEffects read_found_effects(const std::filesystem::path&);

}  // namespace deflect
