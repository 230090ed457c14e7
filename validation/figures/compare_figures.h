// Where a model fails, in pictures: one row of the table each. Of translations in µm, or of rotations in µrad where no
// translation was measured.
#pragma once

#include <vector>

#include "validation/compare/comparison.h"
#include "validation/figures/gnuplot.h"

namespace deflect::figures {

/// Those that the data allow: residuals, residual-map, groups, secant, elongation, loops. What each shows is said where
/// it is drawn.
std::vector<Figure> compare_figures(const compare::Comparison&, const FigureStyle& = {});

}  // namespace deflect::figures
