// The places of a machine, derived from its parts.
#pragma once

#include <vector>

#include "msa/mechanism/description.h"
#include "validation/subject/place.h"

namespace deflect::subject {

/// All places of a machine as described, in the order of its file: every freedom of every joint; tx and ty of a joint
/// together (across its axis), and rx and ry together (tilt), where both are rigid or elastic, alike and of one kind;
/// members; their ends where no joint is there; bars that can carry only a force along themselves; materials, where
/// there are several; dimensions of sections; the base and the tool. A place that is the same in all legs is listed
/// once.
std::vector<Place> places_of(const Mechanism&);

}  // namespace deflect::subject
