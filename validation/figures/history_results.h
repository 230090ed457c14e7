// The error falling from version to version of a device: table, JSON, figure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/compare/comparison.h"
#include "validation/figures/gnuplot.h"

namespace deflect {

/// Versions of a device in order, beside the same measurements; they must outlive it.
struct History {
  const std::vector<Comparison>& versions;
  /// Of each version but the first: the rmse that a placebo in its place would have reached, m or rad.
  std::vector<std::optional<double>> placebo;
};
History history(const std::vector<Comparison>&);

/// One row per device, in order: rms of fitted and held-out poses, χ², what noise and tolerances give, tests that fail,
/// findings, tolerances beyond two standard deviations.
std::string history_report(const History&);
std::string history_json(const History&);
std::string history_csv(const History&);

/// "history": bars of the residual, of held-out poses and of the placebo by version, over the line of noise and
/// tolerances.
Figure history_figure(const History&, const FigureStyle& = {});

}  // namespace deflect
