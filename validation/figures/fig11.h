// The paper's Fig. 11: stiffness over the workspace, as slices by direction and against the guideways' length.
#pragma once

#include <vector>

#include "validation/figures/gnuplot.h"
#include "validation/theories/map.h"

namespace deflect {

/// Columns: stiffness 1/C_ii along x, y, z, N/mm, positive where the tool point yields along the force. Rows: up to
/// three heights (the highest, the middle and the lowest of the grid), and a vertical slice through the middle. Colours
/// on one logarithmic scale, interpolated between poses, with iso-curves; grey hatching where a pose is out of reach.
/// `fig11` is empty where the grid has no plane (fewer than two axes with two values) or no pose is reached.
std::vector<Figure> fig11(const StiffnessMap&, const FigureStyle& = {});

/// The paper's finding: 1/C_ii at every pose against the mean length of the guideways there, by direction, with the
/// median over poses of like length. Named "stiffness-vs-length". Empty where no pose is reached.
std::vector<Figure> stiffness_against_length(const StiffnessMap&, const FigureStyle& = {});

}  // namespace deflect
