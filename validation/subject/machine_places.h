// The places of a machine, from what its parts are.
#pragma once

#include <vector>

#include "msa/mechanism/description.h"
#include "validation/subject/place.h"

namespace deflect::subject {

/// Of a machine as it is described, in the order of its file: every freedom of every joint, tx and ty of a joint and rx
/// and ry together where they are held alike (across its axis, tilt), members, their ends where no joint stands there,
/// bars that carry a force along themselves alone, materials where there are several, dimensions of sections, the base
/// and the tool. The same place of all legs stands once.
std::vector<Place> places_of(const Mechanism&);

}  // namespace deflect::subject
