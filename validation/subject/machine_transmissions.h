// How statics passes loads on to the places of a machine (Transmissions in subject.h).
#pragma once

#include <memory>
#include <vector>

#include "msa/mechanism/configuration.h"
#include "validation/subject/subject.h"

namespace deflect::subject {

/// The machine stands, as drawn, in these configurations, one for each pose. Null where the force at a place is not
/// proportional to the load: weight, misfits, preloads, play, friction; laws that bend, where the forces hang on them.
/// In a determinate machine they do not. The freedoms of a member as a whole are those of its sections, which yield by
/// a linear law alike all along it; the law is that of a unit of length.
std::unique_ptr<const Transmissions> transmissions_of(const Mechanism&, const std::vector<Configuration>&);

}  // namespace deflect::subject
