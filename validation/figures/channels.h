// Residuals of a subject that is read by named sensors, channel by channel.
#pragma once

#include <optional>

#include "validation/compare/comparison.h"
#include "validation/figures/gnuplot.h"

namespace deflect::figures {

/// A panel for each channel: measured − predicted in the unit of the channel, in the order taken, over the band of ±2
/// standard deviations of what noise and tolerances give. At most 24 channels: those with the largest residuals beside
/// their bands.
std::optional<Figure> channels(const compare::Comparison&, const FigureStyle&);

}  // namespace deflect::figures
