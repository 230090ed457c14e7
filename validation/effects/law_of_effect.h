// The law that an effect of a place puts in series there.
#pragma once

#include <optional>

#include "msa/base/spatial.h"
#include "msa/mechanism/law.h"
#include "validation/effects/effect.h"

namespace deflect::effects {

/// Of an effect with one parameter whose edits all append one law at freedoms of its place that carry force; nothing of
/// others. No law of a place names a material.
std::optional<Law> law_in_series(const Effect&, const VectorX& values);

}  // namespace deflect::effects
