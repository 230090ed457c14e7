// The law that an effect at a place (place_effects.h) adds in series there.
#pragma once

#include <optional>

#include "msa/base/spatial.h"
#include "msa/mechanism/law.h"
#include "validation/effects/effect.h"

namespace deflect::effects {

/// Returns a law only for an effect with one parameter whose edits all append the same law at load-carrying freedoms of
/// its place. The law of such an effect never names a material.
std::optional<Law> law_in_series(const Effect&, const VectorX& values);
/// At the start values.
std::optional<Law> law_in_series(const Effect&);

}  // namespace deflect::effects
