// Machine elements of a joint as small structures of beams: their stiffness is solved for, not written down.
#pragma once

#include "msa/frame/elements/spring_law.h"
#include "msa/mechanism/law.h"

namespace deflect::frame {

/// The spring that a law of the description is in the frame model. Contact laws become springs after K. L. Johnson,
/// Contact Mechanics, 1985: point contact (4.23), F = 4/3 E* √R δ^{3/2} with R = 2R' the equivalent ball; line contact
/// from the half width (4.43) as the chord b²/2R of the cylinder, k = π E* l / 2. Pins, shafts, cables and belts are
/// assembled from beam elements and constraints and condensed to the freedom they act on.
SpringLaw spring_of(const Law&);

}  // namespace deflect::frame
