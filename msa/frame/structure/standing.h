// Proof that a structure can stand, from its connections only, before any number is computed.
//
// In a motion without strain every beam (with positive rigidities) and every weld moves as a rigid body. Nodes that
// they connect move as one body with six coordinates. Where the constraints on nodes of that body alone, with lever
// arms, have rank six, the body cannot move; further connections only add restraint. The proof does not cover every
// structure that can stand: trusses and mechanisms are held by more than one body.
#pragma once

#include <string>

#include "msa/frame/structure/model.h"

namespace deflect::frame {

/// Empty where the structure is proved to stand; else a clause with the first body for which the proof fails.
std::string not_proved_standing(const Model&);

}  // namespace deflect::frame
