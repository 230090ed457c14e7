// The machine of these tests, and effects on it as rivals.
#pragma once

#include <string>

#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "validation/plan/rival.h"

namespace deflect::plan {

inline const Mechanism& machine() {
  static const Mechanism m = test::device("haptic-6psu-ideal-joints");
  return m;
}

inline Rival rival(const std::string& name, const VectorX& at) { return {{{&test::effect(name), {}}}, at, 0.5}; }

}  // namespace deflect::plan
