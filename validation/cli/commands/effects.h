// The effects that commands know.
#pragma once

#include <string>
#include <vector>

#include "validation/effects/effect.h"

namespace deflect::cli {

/// The catalogue and the user's own files.
std::vector<Effect> known_effects(const std::vector<std::string>& files);

}  // namespace deflect::cli
