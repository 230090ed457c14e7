// Tolerances of single numbers of a frame: what was built deviates from what was drawn.
//
// A key of `tolerances:` beside `modulus` and `load` is one of
//   a kind of part and a field   member.bending_factor, section.wall, material.E, spring.uz.stiffness,
//   support.uz.stiffness;
//                                node.position is each coordinate of each node, in the plane of a plane frame
//   a path                       "members.beam.bending_factor", "members.*.bending_factor"; indices may be left out
// Its value is a standard deviation: relative with "%", else absolute in a unit of the number ("1 mm"). Every number is
// off on its own.
#pragma once

#include <string>
#include <vector>

#include "msa/fields/number_walk.h"
#include "msa/frame/file/frame_description.h"

namespace deflect::frame {

/// One standard deviation of each, `modulus` included: E, and G where it is given, of one material together. Indices
/// are those of for_each_number (frame_file.h).
std::vector<NumberMove> number_moves(const FrameDescription&);

/// The frame so many standard deviations off. A member whose ends move does not turn about itself: without y_axis its
/// local y stays the one drawn, as far as it is across the member, whatever vector is implied there (member_axes.h).
FrameDescription moved(const FrameDescription&, const NumberMove&, double times = 1);

/// InputError where a key means no number, or its value is no standard deviation of one.
void require_tolerance(const FrameDescription&, const std::string& key, const std::string& value);

}  // namespace deflect::frame
