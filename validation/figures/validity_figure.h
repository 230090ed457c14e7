// A validation study as a figure.
#pragma once

#include "validation/figures/gnuplot.h"
#include "validation/validity/validation.h"

namespace deflect::figures {

/// "validation": for every quantity the errors E over u_val, their mean and two of their standard deviations to either
/// side; and both distribution functions of u-pooling, that of the measurements and the diagonal.
Figure validity_figure(const validity::ValidationStudy&, const FigureStyle& = {});

}  // namespace deflect::figures
