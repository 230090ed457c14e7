// The freedoms in which the nodes of a frame move.
#pragma once

#include <vector>

#include "validation/subject/frame_readings.h"
#include "validation/subject/subject.h"

namespace deflect::subject {

/// Each freedom in which a load of the measurements moves a node, by what is known of the frame in linear geometry.
/// None where nothing is known, the frame has laws that are not linear, or there are more than a thousand.
std::vector<NodeMotion> node_motions_of(const frame::FrameDescription&, const measurement::Measurements&,
                                        const FrameNearby&);

}  // namespace deflect::subject
