// A mesh of straight two-node lines with fields on it: what subdivision gives and what the exporters take.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "msa/base/spatial.h"

namespace deflect {

struct LineCell {
  int a = 0, b = 0;  ///< points
  int group = 0;     ///< index into LineMesh::groups
};

/// Points in m, base axes. Every cell belongs to one named group ("leg 1 guideway", "platform").
struct LineMesh {
  std::vector<Vector3> points;
  std::vector<LineCell> cells;
  std::vector<std::string> groups;
};

/// A vector at every point; the name carries quantity and unit ("displacement_mm", "rotation_rad").
struct PointField {
  std::string name;
  std::vector<Vector3> values;
};

/// A number in every cell ("axial_force_N").
struct CellField {
  std::string name;
  std::vector<double> values;
};

struct FieldData {
  std::vector<PointField> points;
  std::vector<CellField> cells;
};

/// What the exporters rely on: indices within range, one finite value per point or cell, field names that are
/// neither empty nor used twice nor "group". A caller that breaks this has a defect: std::invalid_argument
/// naming the place.
void check(const LineMesh&, const FieldData&);

}  // namespace deflect
