// Mechanisms of the family "chains" in tests: joint states, poses in the workspace, compliance by each theory.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "msa/base/error.h"
#include "msa/mechanism/configuration.h"
#include "tests/support/devices.h"

namespace deflect::test {

/// Half the edges of the box around the workspace, m; of a list of poses zero.
inline Vector3 half_extent(const Mechanism& m) {
  const WorkspaceShape& shape = m.workspace.shape;
  if (const auto* s = std::get_if<CubeSpace>(&shape)) return Vector3::Constant(s->edge / 2);
  if (const auto* s = std::get_if<BoxSpace>(&shape)) return s->edges / 2;
  if (const auto* s = std::get_if<DiscSpace>(&shape)) return {s->radius, s->radius, 0};
  if (const auto* s = std::get_if<CylinderSpace>(&shape)) return {s->radius, s->radius, s->height / 2};
  return Vector3::Zero();
}

/// Poses that the device takes, in the box around its workspace; where it has six coordinates, tilted by up to `tilt`
/// (rad) about each axis. In a fixed order.
inline std::vector<Pose> workspace_poses(const Mechanism& m, int count, double tilt = 0.1, unsigned seed = 1) {
  std::mt19937 random(seed);
  const Pose centre = home_pose(m);
  const bool tilts = actuators_of(m).size() == 6;
  std::vector<Pose> poses;
  for (int tries = 0; static_cast<int>(poses.size()) < count && tries < 20 * count; ++tries) {
    Pose pose = centre;
    pose.p_WT += half_extent(m).cwiseProduct(random_vector(random, 1));
    if (tilts) pose.R_WT = centre.R_WT * rotation_from_vector(random_vector(random, tilt));
    try {
      configure(m, pose);
      poses.push_back(pose);
    } catch (const ModelError&) {  // out of reach
    }
  }
  return poses;
}

/// The values of all actuators.
inline VectorX coordinates(const Configuration& c) {
  VectorX q(static_cast<Eigen::Index>(c.actuators.size()));
  for (std::size_t i = 0; i < c.actuators.size(); ++i) q(static_cast<Eigen::Index>(i)) = c.actuators[i].value;
  return q;
}

/// How far two poses lie apart: m, and rad as if at 1 m.
inline double distance(const Pose& a, const Pose& b) {
  return (a.p_WT - b.p_WT).norm() + Eigen::AngleAxisd(a.R_WT.transpose() * b.R_WT).angle();
}

/// ‖A − B‖ / ‖B‖ of matrices over [m, rad], rotations weighed by `length`.
inline double stiffness_difference(const Matrix6& A, const Matrix6& B, double length) {
  Vector6 w = Vector6::Ones();
  w.tail<3>().setConstant(1 / length);
  const Matrix6 a = w.asDiagonal() * A * w.asDiagonal(), b = w.asDiagonal() * B * w.asDiagonal();
  return (a - b).norm() / b.norm();
}

/// The same of compliances.
inline double compliance_difference(const Matrix6& A, const Matrix6& B, double length) {
  return stiffness_difference(A, B, 1 / length);
}

/// Displacements of T under unit forces and moments, by any theory that has solve(F).displacement.
template <class Theory>
Matrix6 compliance_by(Theory&& theory) {
  Matrix6 C;
  for (Eigen::Index i = 0; i < 6; ++i) C.col(i) = theory.solve(Vector6::Unit(i)).displacement;
  return C;
}

/// A random rotation, of any angle.
inline Matrix3 random_rotation(std::mt19937& random) {
  return rotation_from_vector(random_vector(random, 1).normalized() * uniform(random, -pi, pi));
}

}  // namespace deflect::test
