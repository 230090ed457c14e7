// The effects that commands know.
#pragma once

#include <string>
#include <vector>

#include "validation/effects/effect.h"
#include "validation/subject/subject.h"

namespace deflect::cli {

/// The catalogue and the user's own files.
std::vector<effects::Effect> known_effects(const std::vector<std::string>& files);
/// And the laws at the subject's places (place_effects.h).
std::vector<effects::Effect> known_effects(const std::vector<std::string>& files, const subject::Subject&);

}  // namespace deflect::cli
