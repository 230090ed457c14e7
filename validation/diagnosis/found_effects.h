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
  std::optional<int> leg;  ///< from "leg": 4, else from "site": "leg 4"
  std::vector<std::pair<std::string, double>> parameters;
};

/// Effects of which the data support one as much as the other.
struct FoundTie {
  struct Rival {
    double probability = 0;            ///< among all that could take its place
    std::vector<FoundEffect> effects;  ///< fitted together: what was found beside it, then the rival itself
  };
  std::vector<Rival> rivals;  ///< best first
};

struct FoundEffects {
  std::vector<FoundEffect>
      missing;  ///< in the order in which they were added; values from "found", else from the best candidate
  std::vector<FoundEffect> candidates;  ///< every hypothesis, best first
  std::vector<FoundTie> ties;           ///< empty in results of versions before
  std::string data;                     ///< the measurements that were diagnosed; empty likewise
  std::string verdict, unexplained;     ///< as the result has them: "unknown_effect", and the pattern that is left
};

/// Throws InputError with the file and the JSON member that does not match the format.
FoundEffects read_found_effects(const std::filesystem::path&);

/// The same from text; `origin` takes the place of the file's name in messages.
FoundEffects parse_found_effects(const std::string& json, const std::string& origin);

/// The effect with the values found. Throws InputError where the effect lacks a parameter, a parameter has no value, or
/// a value is out of bounds.
effects::EffectInstance instance(const effects::Effect&, const FoundEffect&);

}  // namespace deflect::diagnosis
