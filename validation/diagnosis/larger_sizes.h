// Effects that do not grow in proportion. Play wider than the motion at its place, a support that yields until it is
// gone: what they do when they are large has another direction than the signature, which is taken where they are small.
#pragma once

#include <optional>

#include "validation/diagnosis/hypothesis.h"

namespace deflect::diagnosis {

/// A value of the last effect's one parameter, and χ² with it.
struct SizedEffect {
  VectorX value;
  double chi2 = 0;
};

/// From `small`, what the signature says (signatures.h), on to sizes up to 128 times as far from the value at which the
/// effect vanishes, within its bounds, as long as each explains more than the one before. `from`: values of the effects
/// before. Nullopt where none of them can be predicted.
std::optional<SizedEffect> best_size(const Observations&, const Hypothesis&, const VectorX& from, const VectorX& small);

}  // namespace deflect::diagnosis
