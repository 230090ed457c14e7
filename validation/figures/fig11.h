// The paper's Fig. 11: stiffness over the workspace, as slices by direction of the force.
#pragma once

#include <vector>

#include "validation/figures/gnuplot.h"
#include "validation/studies/map.h"

namespace deflect::figures {

/// Columns: stiffness 1/C_ii along x, y, z, N/mm, positive where the tool point yields along the force. Rows: up to
/// three heights (the highest, the middle and the lowest of the grid), and a vertical slice through the middle. Colours
/// on one logarithmic scale, interpolated between poses, with iso-curves; grey hatching where a pose is out of reach.
/// Empty where the grid has no plane (fewer than two axes with two values) or no pose is reached.
std::vector<Figure> fig11(const studies::StiffnessMap&, const FigureStyle& = {});

}  // namespace deflect::figures
