// Data that are not what they say: mistakes of recording, which no physics explains.
#pragma once

#include <string>
#include <vector>

#include "validation/compare/patterns.h"

namespace deflect {

/// Sentences "these data look like …", each with its remedy: swapped axes, turned signs, a load in kgf, lengths in m or
/// µm, moments in Nm, a load about another point, readings that contradict each other. Empty where nothing looks so.
/// A mistake is told when its correction leaves less than a third of a misfit that is more than a quarter of what was
/// measured; of several corrections the best is told.
std::vector<std::string> what_data_look_like(const ResidualStudy&);

}  // namespace deflect
