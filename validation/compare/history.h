// Successive versions of a device compared with the same measurements, and the error that a placebo in place of each
// change reaches (placebo.h).
#pragma once

#include <optional>
#include <vector>

#include "validation/compare/comparison.h"

namespace deflect::compare {

/// The comparisons of the versions in order; they must outlive it.
struct History {
  const std::vector<Comparison>& versions;
  /// For each version except the first: the rmse of a placebo in its place, m or rad.
  std::vector<std::optional<double>> placebo;
};
History history(const std::vector<Comparison>&);

}  // namespace deflect::compare
