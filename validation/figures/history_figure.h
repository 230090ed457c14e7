// The error falling from version to version of a device as a figure.
#pragma once

#include "validation/compare/history.h"
#include "validation/figures/gnuplot.h"

namespace deflect::figures {

/// "history": bars of the residual, of held-out poses and of the placebo by version, over the line of noise and
/// tolerances.
Figure history_figure(const compare::History&, const FigureStyle& = {});

}  // namespace deflect::figures
