// Axes of a straight member in space.
#pragma once

#include "msa/base/spatial.h"

namespace deflect::frame {

/// The vector that a zero y_axis stands for: the base z, or the base x where the sine of the angle between the member
/// and the base z is below 1e-3.
inline Vector3 implied_y_axis(const Vector3& along) {
  const bool vertical = along.head<2>().norm() < 1e-3 * along.norm();
  return vertical ? Vector3::UnitX() : Vector3::UnitZ();
}

/// Columns: local x along `along`, y in the plane of x and `y_axis`, z, in base axes. A zero y_axis means
/// implied_y_axis. Throws std::invalid_argument when `along` is parallel to y_axis to 1e-9.
inline Matrix3 member_axes(const Vector3& along, const Vector3& y_axis) {
  return axes_along_x(along, y_axis.isZero(0) ? implied_y_axis(along) : y_axis);
}

}  // namespace deflect::frame
