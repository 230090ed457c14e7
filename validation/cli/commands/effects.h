// The effects that commands know.
#pragma once

#include <string>
#include <vector>

#include "validation/effects/effect.h"

namespace deflect::cli {

/// The catalogue and the user's own files.
std::vector<Effect> known_effects(const std::vector<std::string>& files);

/// Throws InputError "GIVEN: the value must lie between … and …" with the remedy, unless it does.
void require_in_bounds(const std::string& given, const Effect&, const EffectParameter&, double value);

}  // namespace deflect::cli
