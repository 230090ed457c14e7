// The error falling from version to version of a device: table, JSON, figure.
#pragma once

#include <string>
#include <vector>

#include "validation/compare/comparison.h"
#include "validation/report/gnuplot.h"

namespace deflect {

/// One row per device, in order: rms of fitted and held-out poses, χ², what noise and tolerances give, tests that fail,
/// findings, tolerances beyond two standard deviations.
std::string history_report(const std::vector<Comparison>&);
std::string history_json(const std::vector<Comparison>&);
std::string history_csv(const std::vector<Comparison>&);

/// "history": bars of the residual and of held-out poses by version, over the line of noise and tolerances.
Figure history_figure(const std::vector<Comparison>&);

}  // namespace deflect
