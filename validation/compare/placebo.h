// Whether an error falls because the change is right, or because any change of its size would have done.
#pragma once

#include "validation/compare/comparison.h"

namespace deflect::compare {

/// Rmse of translations (m), or of rotations alone (rad), that a placebo reaches: the change of the predictions from
/// one version of the device to the next, its sign drawn by lot for every pose, at the size that fits best; the median
/// of 99 draws. A change that is right does better than this, one that fits any data no better. Deterministic.
double placebo_rmse(const Comparison& before, const Comparison& after);

}  // namespace deflect::compare
