// What stands between a machine and the file at one pose: the loads that act when some are recorded, and what is
// recorded of a displacement.
#pragma once

#include "msa/mechanism/description.h"
#include "validation/measurement/measurements.h"

namespace deflect::prediction {

/// True loads at T from recorded ones: gain · R(rotation) · recorded, and the moment of those forces that are recorded
/// at T and act at T + point (LoadCell). N, Nm, base axes.
class TrueLoads {
 public:
  TrueLoads(const LoadCell&, const Matrix3& R_WT);

  /// Of all loads of a reading.
  Vector6 at_T(const measurement::Reading& r) const { return moved(cell_ * r.load, r); }
  /// Of those that pass through the tool joint.
  Vector6 through_tool(const measurement::Reading& r) const { return moved(cell_ * (r.load - r.on_platform), r); }
  /// Of a load at a named point, about that point.
  Vector6 at_point(const Vector6& recorded) const { return cell_ * recorded; }

  /// Whether loads that are recorded at T act elsewhere.
  bool elsewhere() const { return !arm_.isZero(0); }
  /// By how much the wrench at T changes as their point turns about T.
  Vector6 turned(const measurement::Reading&, const Matrix3& turn) const;

 private:
  Vector3 force_at_T(const measurement::Reading&) const;
  Vector6 moved(Vector6 wrench, const measurement::Reading&) const;

  Matrix6 cell_;
  Vector3 arm_;  // m, base axes
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
