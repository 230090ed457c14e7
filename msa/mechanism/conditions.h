// Conditions, other than the load, under which an equilibrium is computed.
#pragma once

#include <vector>

#include "msa/base/geometry.h"

namespace deflect {

struct Conditions {
  Conditions(Geometry in = Geometry::linear) : geometry(in) {}

  Geometry geometry;
  double warmer = 0;  ///< K above 20 °C, at which the mechanism was assembled
  /// Slips of the friction elements and deflections that loads have left in tables (TableLaw::left) before the load (m,
  /// rad), in the order of for_each_law (configuration.h); empty: all zero. A solution returns those after the load,
  /// which are those before the next load in a sequence.
  std::vector<double> slips;
};

}  // namespace deflect
