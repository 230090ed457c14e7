// Groups of places of a frame: what is of one kind in the whole frame, on one line of supports, or of one section.
#pragma once

#include <vector>

#include "msa/frame/file/frame_description.h"
#include "validation/subject/place.h"

namespace deflect::subject {

/// Of the places of a frame (places_of), those groups of two or more that are held alike:
///   the supports, "supports.uz", and those on one line along x, y or z, "supports.B.along_x.uz", B the first of them
///     in the file; two nodes are on one line within 1e-6 of the frame's size;
///   the springs, "springs.uz", and those to the ground on one line, "springs.pad.along_x.uz";
///   the rigid, elastic or released ends of members, "ends.tilt", and those of one section, "ends.beam.tilt"; in a
///     plane frame "ends" alone, because there they turn in one way only;
///   the members of one section, "members.chord", and all of them, "members": for heat. Their stiffness is what the
///     dimensions of the section or the materials say.
std::vector<Place> groups_of(const frame::FrameDescription&, const std::vector<Place>&);

}  // namespace deflect::subject
