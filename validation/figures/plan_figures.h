// Plans of measurements drawn: what each further reading brings; which effects a campaign cannot tell apart.
#pragma once

#include "validation/figures/gnuplot.h"
#include "validation/plan/foresight.h"
#include "validation/plan/next_readings.h"

namespace deflect::figures {

/// Expected probability of the true effect and least separation over the number of readings.
Figure plan_figure(const plan::Plan&, const FigureStyle&);

/// Cosines between the signatures of all effects as a matrix, with the smallest size that shows of each.
Figure foresight_figure(const plan::Foresight&, const FigureStyle&);

}  // namespace deflect::figures
