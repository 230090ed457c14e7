// Stiffness over the position of the slides.
#pragma once

#include <vector>

#include "validation/figures/gnuplot.h"
#include "validation/studies/map.h"

namespace deflect::figures {

/// The paper's finding: 1/C_ii at every pose against the mean length of the guideways there, by direction, with the
/// median over poses of like length. Named "stiffness-vs-length". Empty where no pose is reached.
std::vector<Figure> stiffness_against_length(const studies::StiffnessMap&, const FigureStyle& = {});

}  // namespace deflect::figures
