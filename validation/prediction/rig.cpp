#include "validation/prediction/rig.h"

#include "msa/base/spatial.h"

namespace deflect::prediction {

TrueLoads::TrueLoads(const LoadCell& cell, const Matrix3& R_WT, const std::vector<const LoadPoint*>& points)
    : cell_(cell.gain * rotate_twist(rotation_from_vector(cell.rotation))), arm_(R_WT * cell.point) {
  for (const LoadPoint* p : points) points_.push_back({R_WT * p->point, p->body == "platform"});
}

/// What is recorded at T itself.
Vector6 TrueLoads::at_tool(const measurement::Reading& r) const {
  return cell_ * (r.at_points.empty() ? r.load : r.at_tool);
}

/// At T, of all loads or of those beyond the tool joint.
Vector6 TrueLoads::placed(const measurement::Reading& r, bool all) const {
  Vector6 out;
  if (points_.empty()) {
    out = cell_ * (all ? r.load : Vector6(r.load - r.on_platform));
  } else {
    out = at_tool(r);
    for (std::size_t k = 0; k < points_.size(); ++k)
      if (all || !points_[k].on_platform) out += shift_twist(points_[k].arm).transpose() * (cell_ * r.at_points[k]);
  }
  if (!arm_.isZero(0)) out.tail<3>() += arm_.cross(Vector3(at_tool(r).head<3>()));
  return out;
}

Vector6 TrueLoads::at_T(const measurement::Reading& r) const { return placed(r, true); }
Vector6 TrueLoads::through_tool(const measurement::Reading& r) const { return placed(r, false); }

Vector6 TrueLoads::turned(const measurement::Reading& r, const Matrix3& turn) const {
  Vector6 out = Vector6::Zero();
  const auto add = [&](const Vector3& arm, const Vector6& F) {
    out.tail<3>() += (turn * arm - arm).cross(Vector3(F.head<3>()));
  };
  if (!arm_.isZero(0)) add(arm_, at_tool(r));
  for (std::size_t k = 0; k < points_.size(); ++k) add(points_[k].arm, cell_ * r.at_points[k]);
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
