// Under what a mechanism is asked for its equilibrium, beside the load.
#pragma once

#include <vector>

#include "msa/base/geometry.h"

namespace deflect {

struct Conditions {
  Conditions(Geometry in = Geometry::linear) : geometry(in) {}

  Geometry geometry;
  double warmer = 0;  ///< K above 20 °C, at which the mechanism was assembled
  /// State of the frictions before the load (m, rad), in the order of for_each_law (configuration.h); empty: relaxed,
  /// all zero. A solution tells the slips after it, the conditions of the next load in a sequence.
  std::vector<double> slips;
};

}  // namespace deflect
