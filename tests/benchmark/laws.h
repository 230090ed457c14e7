// Laws that no effect of the catalogue describes: what they add to displacements, by formulas of their own.
#pragma once

#include <vector>

#include "tests/benchmark/plan.h"

namespace deflect::benchmark {

struct Law {
  const char* name;
  /// δ of T, m, at an amplitude of 1 µm. f: force of each leg (N), L1: free length of its guideway (m), x: commanded
  /// (m), F: load on T.
  Vector3 (*displacement)(const std::vector<subject::Site>& legs, const VectorX& f, const Vector6& F, double x);
};

const std::vector<Law>& laws();

/// The displacements that the law adds to the plan's readings at an amplitude of 1 µm, by reading.
std::vector<Vector6> added_by(const Law&, const Plan&);

}  // namespace deflect::benchmark
