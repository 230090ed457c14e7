// Axes of a straight member in space.
#pragma once

#include "msa/base/spatial.h"

namespace deflect::frame {

/// Columns: local x along `along`, y in the plane of x and `y_axis`, z, in base axes. A zero y_axis means the base z,
/// or the base x where the sine of the angle between the member and the base z is below 1e-3. Throws
/// std::invalid_argument when `along` is parallel to y_axis to 1e-9.
inline Matrix3 member_axes(const Vector3& along, const Vector3& y_axis) {
  if (!y_axis.isZero(0)) return axes_along_x(along, y_axis);
  const bool vertical = along.head<2>().norm() < 1e-3 * along.norm();
  return axes_along_x(along, vertical ? Vector3::UnitX() : Vector3::UnitZ());
}

}  // namespace deflect::frame
