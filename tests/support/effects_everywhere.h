// Every effect that a diagnosis looks at: the catalogue, and the laws at every place of a subject.
#pragma once

#include "tests/support/effects.h"
#include "validation/effects/place_effects.h"

namespace deflect::test {

inline std::vector<effects::Effect> effects_everywhere(const subject::Subject& s) {
  std::vector<effects::Effect> all = all_effects();
  for (effects::Effect& e : effects::place_effects(s, all_effects())) all.push_back(std::move(e));
  return all;
}

}  // namespace deflect::test
