// Effects that no catalogue holds: a law of each kind at every place of a subject that may yield, for a scan of where
// something acts that no entry explains.
#pragma once

#include <vector>

#include "validation/effects/effect.h"
#include "validation/subject/subject.h"

namespace deflect {

/// Springs, play, one-sided and contact laws of small size at all freedoms of all joints, of every leg and of one, at
/// base and tool.
std::vector<Effect> scanned_effects(const Subject&);

}  // namespace deflect
