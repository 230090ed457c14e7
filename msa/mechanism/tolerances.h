// Tolerances of single numbers of a description: what a machine that was built has beside its drawing.
//
// A key of `tolerances:` beside the six that have a name of their own is one of
//   a path                "leg.elbow.rz.stiffness" of every leg, "leg[2].elbow.rz.stiffness" of one; list indices may
//   be
//                         left out: a vector is its three components, a list of laws all laws that have the field
//   a kind of place and a field
//     drive.FIELD, joint.FIELD     in the laws of driven freedoms; of all other freedoms of joints
//     member.FIELD, member_end.FIELD, section.FIELD, material.FIELD
//     member.length                each member along itself; of a 6-psu its links (as link_length)
//     joint.position               each length that places a joint: seats and offsets per axis, a and d of rows; of a
//                                  6-psu its joints (as joint_position)
// Its value is a standard deviation: relative with "%", else absolute in a unit of the number ("0.1 mm").
//
// Numbers of a leg are off in each leg on its own. Sections, materials and everything else that the file says once for
// all legs are off once for the whole machine.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "msa/fields/number_walk.h"
#include "msa/mechanism/description.h"

namespace deflect {

/// Of a resolved mechanism (device_file.h). Tolerances whose number an effect has taken away are left out.
std::vector<NumberMove> number_moves(const Mechanism& resolved);

/// The resolved mechanism so many standard deviations off.
Mechanism moved(const Mechanism& resolved, const NumberMove&, double times = 1);

/// The six with names of their own, with those that a key means for a 6-psu.
Tolerances named_tolerances(const Mechanism&);

/// InputError where a key means no number, or its value is no standard deviation of one.
void check_tolerance(const Mechanism& resolved, const std::string& key, const std::string& value);

}  // namespace deflect
