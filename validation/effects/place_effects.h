// Effects beyond the catalogue: every law at every place of a subject where physics allows it.
//
//   law        where                                           what it is
//   linear     rigid directions, elastic ones of another law   a spring in series
//   factor     freedoms held by one spring, members,           that stiffness, material, dimension or load times a
//   factor
//              materials, dimensions of sections, load cases
//   gain       named sensors                                   what they read, times a factor
//   zero       named sensors whose zero is taken               what they read, plus a number
//   stiction   sensors of frames                               what they read lags by up to a number
//   crosstalk  two sensors of a frame, of one quantity          what one reads, plus a share of the other
//   turned     load cases                                      turned by small angles
//   heat       members whose material expands                  warmer by a number
//   misfit     members of frames with laws that are not linear, or in the deformed shape: too long by a number
//   settled    rigid directions of supports                    moved by a number
//   clearance  rigid and elastic directions                    free travel to both sides, in series
//   pull push  rigid and elastic directions                    a spring in series that yields in one sense only
//   contact    rigid and elastic translations                  in series, as the force to the power 2/3
//   hardening  drives                                          a spring in series that stiffens
//   friction   free and elastic freedoms                       sticks before it slips, side by side
//   load_friction  drives that yield                           the same, in proportion to the load in what yields
//   restraint  free freedoms                                   a spring side by side
//
// Places may be groups (place_groups.h), in which each part has the law with the same value. Members that have all of
// one section are no place for a factor, because the section's dimensions say the same.
//
// At the ends of a frame's members, which are many, no play and nothing one-sided is looked for.
//
// Where several legs have the place, linear, factor, clearance, friction and hardening of every leg are one effect and
// those of one leg another, because wear takes one. Of groups in one leg only linear and factor: what yields alike in
// many parts is of one make, wear is of one part.
//
// Their ids are law@place: "clearance@elbow.rz" of every leg, "clearance@leg.elbow.rz" of one leg.
#pragma once

#include <string>
#include <vector>

#include "validation/effects/effect.h"
#include "validation/subject/subject.h"

namespace deflect::effects {

/// The place in a sentence: subject::name_of(), but a frame's member, its end, a load and the sensor of a
/// machine say what they are: "member C1b", "displacement sensor".
std::string words_of(const subject::Place&);

/// The laws at the subject's places, without those whose edits are the same as those of one of the `named` effects.
std::vector<Effect> place_effects(const subject::Subject&, const std::vector<Effect>& named);

}  // namespace deflect::effects
