// A channel of a frame that shows another quantity than its name says: a gauge that is screwed on at another node or
// turned into another direction, a cable that is plugged in at another load cell.
#pragma once

#include <cstddef>
#include <vector>

#include "msa/frame/file/frame_description.h"
#include "validation/recording/recorded.h"

namespace deflect::recording {

struct OtherQuantity {
  frame::FrameSensor shown;  ///< in place of the sensor's own; noise, gain and zero are the sensor's
  Correction correction;     ///< of the description
};

/// What a sensor of the frame, by its number among those of the measurements, may show instead in the same unit:
/// displacements of all nodes along the base axes, or rotations about them; the same force of other members, other
/// forces of its own; the strain of the same fibre of other members, or of a mirrored one; the same reaction of other
/// supports, other reactions of its own.
std::vector<OtherQuantity> other_quantities(const measurement::Measurements&, const frame::FrameDescription&,
                                            std::size_t sensor);

}  // namespace deflect::recording
