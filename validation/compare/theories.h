// Both theories at the same poses under the same loads.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "analytic/erratum.h"
#include "msa/mechanism/description.h"

namespace deflect {

/// A pose to be validated: a label for tables ("0" … "8"), x y z roll pitch yaw in mm and deg as written to results.
struct ValidationPoint {
  std::string label;
  Vector6 pose_mm_deg = Vector6::Zero();
};

/// One pose, one load along one axis. Displacements of T in base axes: mm and rad.
struct ValidationRow {
  ValidationPoint point;
  int axis = 0;  ///< 0, 1, 2: force along x, y, z
  double load_N = 0;
  Vector6 analytic, msa;        ///< corrected analytic theory; MSA
  std::optional<Vector6> as_printed;  ///< analytic with the errata asked for, where any were
  double relative_difference = 0;     ///< of analytic and MSA, see relative_difference()
};

struct Validation {
  std::string device;
  std::set<Erratum> as_printed;
  std::vector<ValidationRow> rows;  ///< point by point, x y z each
  double max_relative_difference = 0, rms_relative_difference = 0;
};

/// The larger of |δa − δb| / |δb| and |θa − θb| / |θb|, Euclidean norms of the translation and of the rotation; a
/// rotation below 1e-9 of translation per metre, which is rounding, counts against that floor.
double relative_difference(const Vector6& a, const Vector6& b);

/// Centre (0) and corners of the cube of the device's workspace: 1…4 upper face, 5…8 lower, each in the order
/// (+,+), (−,+), (−,−), (+,−) of (x, y).
std::vector<ValidationPoint> cube_points(const Mechanism&);

}  // namespace deflect
