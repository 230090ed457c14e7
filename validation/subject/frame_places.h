// The places of a frame, derived from its parts.
#pragma once

#include <vector>

#include "msa/frame/file/frame_description.h"
#include "validation/subject/place.h"

namespace deflect::subject {

/// All places of a frame, in the order of its file: each freedom of each support, those that it leaves free too; each
/// freedom of each spring; members, and the rotations of their ends; materials, where there are several; dimensions of
/// sections; load cases; sensors, and each with each other of its quantity. In a plane frame without the freedoms that
/// leave the plane.
std::vector<Place> places_of(const frame::FrameDescription&);

/// Whether a plane frame cannot move in this freedom of a node.
bool out_of_plane(const frame::FrameDescription&, std::size_t freedom);

/// What a sensor reads.
measurement::Quantity quantity_of(const frame::FrameSensor&);

}  // namespace deflect::subject
