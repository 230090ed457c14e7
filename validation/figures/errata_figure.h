// The price of the paper's errata as a picture.
#pragma once

#include <vector>

#include "validation/figures/gnuplot.h"
#include "validation/studies/errata_prices.h"
#include "validation/studies/validate.h"

namespace deflect::figures {

/// "errata": a row for each erratum, and in it a line for the load along x, y, z from the smallest to the largest ratio
/// of the deflections as printed and corrected, and a dot at the end that is farther from 1. The axis is signed:
/// the logarithm of the change up to a factor of 2, linear within a thousandth, beyond it that of the factor; to the
/// left what the erratum makes too stiff. A ratio that is not above 0, or not finite, stands as a number in its row.
Figure errata_figure(const std::vector<studies::ErratumPrice>&, const studies::Validation&, const FigureStyle& = {});

}  // namespace deflect::figures
