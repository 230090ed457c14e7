// Displacement over load, component by component, measured and predicted; of readings under one component of the load
// alone. Empty where there are none.
#pragma once

#include <optional>

#include "validation/compare/comparison.h"
#include "validation/figures/gnuplot.h"

namespace deflect::figures {

/// Displacement / load over the load, all poses.
std::optional<Figure> secant(const compare::Comparison&, const FigureStyle& = {});

/// Displacement over load in the order taken, at the pose of the largest misfit.
std::optional<Figure> loops(const compare::Comparison&, const FigureStyle& = {});

}  // namespace deflect::figures
