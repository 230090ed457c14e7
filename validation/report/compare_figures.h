// Where a model fails, in pictures: one row of the table each.
#pragma once

#include <vector>

#include "validation/compare/comparison.h"
#include "validation/report/gnuplot.h"

namespace deflect {

/// Those that the data allow, the first three where translations were measured:
///   residuals       by reading in the order taken, x y z apart, with the band of ±2 standard deviations of what noise
///                   and tolerances give; colour by axis
///   residual-map    rms at each pose in the plane x–y and x–z of the workspace
///   groups          rms by axis, direction, magnitude, heading against what noise and tolerances give
///   secant          displacement over load along the load, measured and predicted, over the load (pure loads only)
///   elongation      force–elongation curves of the sites beyond the model
///   loops           displacement over load at the pose of the largest misfit, measured and predicted
std::vector<Figure> compare_figures(const Comparison&);

}  // namespace deflect
