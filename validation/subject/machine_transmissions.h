// What statics makes of loads at the places of a machine (subject.h).
#pragma once

#include <memory>
#include <vector>

#include "msa/mechanism/configuration.h"
#include "validation/subject/subject.h"

namespace deflect::subject {

/// Of a machine that stands in these configurations as drawn, one for each pose. Null where the force at a place is
/// more than a share of the load: laws that are not linear, weight, misfits, preloads.
std::unique_ptr<const Transmissions> transmissions_of(const Mechanism&, const std::vector<Configuration>&);

}  // namespace deflect::subject
