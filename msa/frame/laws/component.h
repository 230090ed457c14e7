// Machine elements of a joint as small structures of beams: their stiffness is computed by the frame solver instead of
// a formula.
#pragma once

#include "msa/frame/elements/spring_law.h"
#include "msa/mechanism/law.h"

namespace deflect::frame {

/// The spring that represents a law of the description in the frame model. Contact laws become springs after K. L.
/// Johnson, Contact Mechanics, 1985: point contact (4.23), F = 4/3 E* √R δ^{3/2} with R = 2R' the radius of the
/// equivalent ball; line contact with the approach b²/2R from the half width b (4.43), k = π E* l / 2. Pins, shafts,
/// cables and belts are assembled from beam elements and constraints and condensed to the freedom that they act on.
SpringLaw spring_of(const Law&);

}  // namespace deflect::frame
