// The catalogue for tests.
#pragma once

#include "tests/support/paths.h"
#include "validation/effects/effect_file.h"
#include "validation/effects/with_effect.h"

namespace deflect::test {

inline const std::vector<effects::Effect>& all_effects() {
  static const std::vector<effects::Effect> all =
      effects::catalogue(test::source_dir() + "/validation/effects/catalogue");
  return all;
}

inline const effects::Effect& effect(const std::string& name) { return effects::find_effect(all_effects(), name); }

/// With the leg that an effect of one leg needs.
inline std::optional<int> some_leg(const effects::Effect& e) {
  return e.scope == effects::Scope::one_leg ? std::optional(4) : std::nullopt;
}

inline VectorX values(std::initializer_list<double> numbers) {
  VectorX out(static_cast<Eigen::Index>(numbers.size()));
  std::copy(numbers.begin(), numbers.end(), out.begin());
  return out;
}

/// An effect's file that is right, with one place of it changed.
inline std::string effect_text(const std::string& from = "", const std::string& to = "") {
  std::string text = R"(name: soft_pad
title: A pad under the tool
scope: machine
parameters:
  stiffness_N_per_mm: {start: 500, low: 10, high: 1e5, scale: log, vanishes: infinity, about: of the pad}
edits:
  - {at: tool.tz, append: {law: linear, stiffness: $stiffness_N_per_mm}}
pages:
  machine: The pad is pressed.
  data: More displacement along z.
  bench: Measure beside the pad.
  cure: Remove the pad.
)";
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  return text;
}

}  // namespace deflect::test
