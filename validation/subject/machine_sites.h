// Sites of a machine (subject.h): the lines of legs that carry a force along a line only, tension positive; of other
// legs and of arms the driven freedoms of their joints.
#pragma once

#include <vector>

#include "msa/mechanism/configuration.h"
#include "validation/subject/subject.h"

namespace deflect::subject {

/// The sites of a machine where it stands; none where nothing is driven.
std::vector<Site> sites_of(const Configuration&);

}  // namespace deflect::subject
