// The places inside a frame through which force passes.
#pragma once

#include "validation/subject/frame_readings.h"
#include "validation/subject/subject.h"

namespace deflect::subject {

/// Each member along its axis, and each held freedom of each support, by what is known of the frame; none where it has
/// laws that are not linear.
InnerSites inner_sites_of(const frame::FrameDescription&, const measurement::Measurements&, const FrameNearby&);

/// Standing::joint_sites().
std::vector<InnerSite> joint_sites_of(const frame::FrameDescription&, const measurement::Measurements&,
                                      const FrameNearby&);

}  // namespace deflect::subject
