// Resolves the paths of an effect in a mechanism: selectors and alternatives become paths that edited() accepts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "msa/mechanism/description.h"
#include "validation/effects/effect.h"
#include "validation/subject/subject.h"

namespace deflect::effects {

/// The paths of the first alternative that the mechanism has; of one leg only where `leg` is given
/// ("leg[4].actuator.tz"). Where a variation replaces a whole field in some leg, the path in that leg is added. Throws
/// InputError with the nearest valid name where no alternative exists.
std::vector<std::string> paths_of(const EffectEdit&, const Mechanism&, std::optional<int> leg);
/// The same of a frame, which has no legs and no drives. Of the selectors it knows <moduli>.
std::vector<std::string> paths_of(const EffectEdit&, const frame::FrameDescription&);
/// Of either; every leg where it has legs.
std::vector<std::string> paths_of(const EffectEdit&, const subject::Subject&);
/// Whether all that the effect edits is within the part with that path ("leg.drive"), in every leg that has it.
bool edits_only(const Effect&, const std::string& part, const subject::Subject&);

}  // namespace deflect::effects
