// Tests whether an error falls because a change is right, or because any change of that size would lower it.
#pragma once

#include "validation/compare/comparison.h"

namespace deflect::compare {

/// Rmse, over translations (m) or rotations (rad) where only these were measured, of a placebo: the change of the
/// predictions from one version of the device to the next, with a random sign for each pose, scaled to fit best; the
/// median of 99 draws. A right change does better than its placebo; one that fits any data does not. Deterministic.
double placebo_rmse(const Comparison& before, const Comparison& after);

}  // namespace deflect::compare
