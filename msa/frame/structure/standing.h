// A proof that a structure can stand, from its connections alone and before any number is computed.
//
// A motion that strains nothing moves every beam as a rigid body, where all rigidities are positive, and every weld.
// What beams and welds hold together then moves as one body, with six numbers; where the constraints that name nodes of
// that body only, taken with arms, have rank six on these, nothing is left. Whatever else joins the bodies only holds
// more. The proof does not find every structure that stands: trusses and mechanisms hold by more than one body.
#pragma once

#include <string>

#include "msa/frame/structure/model.h"

namespace deflect::frame {

/// Empty where the structure is proved to stand; else the first body that this proof does not hold, as a clause.
std::string not_proved_standing(const Model&);

}  // namespace deflect::frame
