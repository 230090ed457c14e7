// The paper's Fig. 10: linear deflection along the load at the points of the workspace, by both theories.
#pragma once

#include "validation/figures/gnuplot.h"
#include "validation/studies/validate.h"

namespace deflect::figures {

/// Upper panel: component `axis` of the translation of T in base axes, mm, for the load in x, y, z; analytic
/// filled, MSA open around it, the theory as printed (where rows carry it) in a lighter shade. Lower panel,
/// same points: analytic − MSA along the load in the unit that suits it, mm … fm. Throws
/// std::invalid_argument without rows and on a deflection that is not finite.
Figure fig10(const studies::Validation&, const FigureStyle& = {});

}  // namespace deflect::figures
