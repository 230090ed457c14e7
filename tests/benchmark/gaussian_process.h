// A discrepancy that knows no physics: a Gaussian process over pose and load.
#pragma once

#include "tests/benchmark/plan.h"

namespace deflect::benchmark {

/// What it adds to the prediction at the plan's new poses, m, learnt from residuals of the plan's numbers. Squared
/// exponential, a length for poses and one for loads, components apart but with the same lengths and size, which are
/// those of the largest marginal likelihood on a coarse grid.
VectorX gaussian_process(const Plan&, const VectorX& residual);

}  // namespace deflect::benchmark
