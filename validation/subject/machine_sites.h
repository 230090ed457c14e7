// Sites of a machine (subject.h). A leg that can carry only a force along one line has that line as its site, tension
// positive. Other legs and serial arms have one site for each driven freedom of their joints.
#pragma once

#include <vector>

#include "msa/mechanism/configuration.h"
#include "validation/subject/subject.h"

namespace deflect::subject {

/// The sites of a machine in this configuration. Legs without a drive have none.
std::vector<Site> sites_of(const Configuration&);

}  // namespace deflect::subject
