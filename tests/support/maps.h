// Small grids of poses for tests.
#pragma once

#include "validation/studies/map.h"

namespace deflect::test {

inline studies::MapOptions cube(const Mechanism& m, int nx, int ny, int nz) {
  studies::MapOptions o;
  o.grid = studies::workspace_grid(m, {nx, ny, nz});
  o.length_mm = studies::weighing_length_mm(m);
  return o;
}

/// A grid of which parts are beyond the links and beyond the sliders.
inline studies::MapOptions too_wide(const Mechanism& m) {
  studies::MapOptions o = cube(m, 5, 5, 5);
  const Vector3 centre = (o.grid.low_mm + o.grid.high_mm) / 2;
  o.grid.low_mm = centre - Vector3(60, 60, 160);
  o.grid.high_mm = centre + Vector3(60, 60, 160);
  return o;
}

}  // namespace deflect::test
