// The usual mistakes of recording where a subject is read by named sensors and loaded by cases and at nodes: units,
// signs, columns, the place of a load.
#pragma once

#include <vector>

#include "msa/frame/file/frame_description.h"
#include "validation/recording/recorded.h"

namespace deflect::recording {

/// Of readings: a channel in another unit or with the other sign, two channels of one quantity in one another's place.
std::vector<Correction> mistaken_channels(const measurement::Measurements&);

/// Of loads: one of them, or all, in another unit or with the other sign.
std::vector<Correction> mistaken_loads(const measurement::Measurements&);

/// A load at a node that stood at another node. Load cases that load nodes alone are written as loads at nodes.
std::vector<Correction> misplaced_loads(const measurement::Measurements&, const frame::FrameDescription&);

}  // namespace deflect::recording
