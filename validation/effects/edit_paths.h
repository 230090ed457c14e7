// Paths of effects in a mechanism: selectors and alternatives worked out to paths that edited() knows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "msa/mechanism/description.h"
#include "validation/effects/effect.h"

namespace deflect::effects {

/// The paths that the first alternative which the mechanism has stands for; those of one leg where it is given
/// ("leg[4].actuator.tz"). A field of every leg that a variation holds whole in some leg is named there too. InputError
/// with the nearest valid name when there is none.
std::vector<std::string> paths_of(const EffectEdit&, const Mechanism&, std::optional<int> leg);

}  // namespace deflect::effects
