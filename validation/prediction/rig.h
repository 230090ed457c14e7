// What stands between a machine and the file at one pose: the loads that act when some are recorded, and what is
// recorded of a displacement.
#pragma once

#include <vector>

#include "msa/mechanism/description.h"
#include "validation/measurement/measurements.h"

namespace deflect::prediction {

/// True loads at T from recorded ones: gain · R(rotation) · recorded, and the moments of those forces that act
/// elsewhere: of what is recorded at T at T + point (LoadCell), of loads at named points at these. N, Nm, base axes.
class TrueLoads {
 public:
  /// `points`: of the loads in Reading::at_points, in their order. Without them a reading counts as it was placed
  /// (place_loads), at the points of the machine that it was read for.
  TrueLoads(const LoadCell&, const Matrix3& R_WT, const std::vector<const LoadPoint*>& points = {});

  /// Of all loads of a reading.
  Vector6 at_T(const measurement::Reading&) const;
  /// Of those that pass through the tool joint.
  Vector6 through_tool(const measurement::Reading&) const;
  /// By how much the wrench at T changes as the points of loads turn about T.
  Vector6 turned(const measurement::Reading&, const Matrix3& turn) const;
  /// Whether that wrench changes so.
  bool any_turns() const { return !points_.empty() || !arm_.isZero(0); }
  /// Whether loads act at named points.
  bool any_named() const { return !points_.empty(); }

 private:
  struct Point {
    Vector3 arm;  // m from T, base axes
    bool on_platform;
  };
  Vector6 placed(const measurement::Reading&, bool all) const;
  Vector6 at_tool(const measurement::Reading&) const;

  Matrix6 cell_;
  Vector3 arm_;  // as of a Point
  std::vector<Point> points_;
};

/// The recorded displacement from the true one of T: R(rotation) · displacement of T + point (Sensor), without its zero
/// and drift. m, rad, base axes.
class RecordedMotion {
 public:
  RecordedMotion(const Sensor&, const Matrix3& R_WT);

  Vector6 of(const Vector6& d_T, Geometry) const;

 private:
  Matrix6 sensor_;
  Vector3 arm_;  // m, base axes
};

}  // namespace deflect::prediction
