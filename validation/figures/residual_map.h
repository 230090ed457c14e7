// The residual over the workspace, signed, component by component.
#pragma once

#include <optional>

#include "validation/compare/comparison.h"
#include "validation/figures/gnuplot.h"

namespace deflect::figures {

/// What is drawn of a pose, component k of measured − predicted Δ and of the load F, over its readings; gross outliers
/// left out. NaN where nothing was measured or loaded.
struct SignedResidual {
  Vector3 along;  ///< Σ F_k Δ_k / Σ |F_k|: positive where the machine yields more than predicted; odd in the load
  Vector3 mean;   ///< of Δ_k: what does not change its sign with the load
};
std::vector<SignedResidual> signed_residuals(const compare::Comparison&);

/// "residual-map": both at every pose, the workspace seen obliquely (x to the right, z up, y into the page), colours
/// from blue (negative) through white to red on one scale that is symmetric about 0; circles positive, squares
/// negative.
std::optional<Figure> residual_map(const compare::Comparison&, const FigureStyle& = {});

}  // namespace deflect::figures
