// How large residuals are, in all and by group.
#pragma once

#include "validation/compare/comparison.h"

namespace deflect {

/// Fills `all`, `by_axis`, `by_pose`, `by_direction`, `by_magnitude` and, with a sequence, `by_heading`.
void add_errors(Comparison&);

}  // namespace deflect
