// Groups of places of a machine: what is of one kind in one leg or in one stage.
#pragma once

#include <vector>

#include "validation/subject/place.h"

namespace deflect::subject {

/// Of the places of a machine (places_of), those groups of two or more that are held alike in the same freedoms: the
/// drives; the joints of one type, "revolute_joints.tilt", and those of all types, "joints.tilt"; the members, and
/// those of one section; the ends of members without joints, "ends.rz"; bars along their lines, "bars.tx". Each
///   in a leg, "drives.rz" (a leg of its own description: "mounts.1.drives.rz"), and in all legs together where some
///     have descriptions of their own, "legs.drives.rz";
///   in a stage, which is a part with branches, "portal.members", and in a branch of its own description,
///     "portal.mounts.0.members".
/// A group that is the same in every leg is listed once, as a place is.
std::vector<Place> groups_of(const std::vector<Place>&);

}  // namespace deflect::subject
