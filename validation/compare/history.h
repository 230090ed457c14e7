// Versions of a device in order, beside the same measurements, and what a placebo in place of each would reach.
#pragma once

#include <optional>
#include <vector>

#include "validation/compare/comparison.h"

namespace deflect::compare {

/// Versions of a device in order, beside the same measurements; they must outlive it.
struct History {
  const std::vector<Comparison>& versions;
  /// Of each version but the first: the rmse that a placebo in its place would have reached, m or rad.
  std::vector<std::optional<double>> placebo;
};
History history(const std::vector<Comparison>&);

}  // namespace deflect::compare
