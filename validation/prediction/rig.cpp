#include "validation/prediction/rig.h"

#include "msa/base/spatial.h"

namespace deflect::prediction {

TrueLoads::TrueLoads(const LoadCell& cell, const Matrix3& R_WT)
    : cell_(cell.gain * rotate_twist(rotation_from_vector(cell.rotation))), arm_(R_WT * cell.point) {}

Vector3 TrueLoads::force_at_T(const measurement::Reading& r) const {
  return (cell_ * (r.at_points.empty() ? r.load : r.at_tool)).head<3>();
}

Vector6 TrueLoads::moved(Vector6 wrench, const measurement::Reading& r) const {
  if (elsewhere()) wrench.tail<3>() += arm_.cross(force_at_T(r));
  return wrench;
}

Vector6 TrueLoads::turned(const measurement::Reading& r, const Matrix3& turn) const {
  Vector6 out = Vector6::Zero();
  if (elsewhere()) out.tail<3>() = (turn * arm_ - arm_).cross(force_at_T(r));
  return out;
}

RecordedMotion::RecordedMotion(const Sensor& sensor, const Matrix3& R_WT)
    : sensor_(rotate_twist(rotation_from_vector(sensor.rotation))), arm_(R_WT * sensor.point) {}

Vector6 RecordedMotion::of(const Vector6& d_T, Geometry geometry) const {
  if (arm_.isZero(0)) return sensor_ * d_T;
  const Vector3 theta = d_T.tail<3>();
  Vector6 out = d_T;
  if (geometry == Geometry::finite)
    out.head<3>() += rotation_from_vector(theta) * arm_ - arm_;
  else
    out.head<3>() += theta.cross(arm_);
  return sensor_ * out;
}

}  // namespace deflect::prediction
