// Where a model fails, in pictures: one row of the table each. Of translations in µm, or of rotations in µrad where no
// translation was measured.
#pragma once

#include <vector>

#include "validation/compare/comparison.h"
#include "validation/figures/gnuplot.h"

namespace deflect::figures {

/// Those that the data allow:
///   residuals       by reading in the order taken, x y z apart, with the band of ±2 standard deviations of what noise
///                   and tolerances give; colour by axis
///   residual-map    signed residual of each component at each pose of the workspace (residual_map.h)
///   groups          rms by axis, direction, magnitude, heading against what noise and tolerances give
///   secant          displacement over load along the load, measured and predicted, over the load (load_curves.h)
///   elongation      force–elongation curves of the sites beyond the model
///   loops           displacement over load at the pose of the largest misfit, measured and predicted
std::vector<Figure> compare_figures(const compare::Comparison&, const FigureStyle& = {});

}  // namespace deflect::figures
