// One pose, one load, both theories: what `deflect solve` reports.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "meshes/line_mesh.h"
#include "msa/base/geometry.h"
#include "msa/base/spatial.h"

namespace deflect {

/// What one theory says of the tool point T, in base axes.
struct TheorySolution {
  Vector6 displacement_mm_rad = Vector6::Zero();  ///< ux uy uz (mm), thx thy thz (rad)
  Matrix6 stiffness_mm = Matrix6::Zero();         ///< wrench (N, Nmm) per displacement: N/mm, N, Nmm
};

/// The mechanism assembled with its misfits, without load and weight.
struct Assembly {
  Vector6 analytic_mm_rad, msa_mm_rad;                              ///< T beside its place in the drawing
  std::vector<std::pair<std::string, Vector6>> leg_wrenches_N_Nmm;  ///< by the closed form: platform on leg, at T
};

/// Play that nothing loads: the displacement is its middle, from which T may move without force.
struct FloatingPlay {
  std::vector<std::string> parts;                                         ///< that have it
  Vector6 least_mm_rad = Vector6::Zero(), most_mm_rad = Vector6::Zero();  ///< along each axis, from the middle
};

struct JointValue {
  std::string name;
  double value = 0;
  bool rotation = false;  ///< rad, otherwise mm
};

struct SolveResult {
  Vector6 pose_mm_deg = Vector6::Zero();  ///< x y z (mm), roll pitch yaw (deg)
  Vector6 load_N_Nmm = Vector6::Zero();   ///< on T about T in base axes: fx fy fz (N), mx my mz (Nmm)
  Geometry geometry = Geometry::linear;
  TheorySolution analytic, msa;
  /// By how much the displacement in the deformed shape differs from the linear one, relative_difference() in
  /// theories.h.
  double analytic_from_linear = 0, msa_from_linear = 0;
  double relative_difference = 0;  ///< of the displacements, see relative_difference() in theories.h
  /// Finite: about what dividing members leaves of relative_difference, of both theories together.
  double discretisation = 0;
  /// Checks of the stiffness; the last one of linear geometry only.
  bool symmetric = false, positive = false, passive_joints_free = false;
  std::vector<std::pair<std::string, double>> shares;  ///< part, its share of the strain energy
  std::vector<JointValue> joints;                      ///< commanded coordinates
  int redundant_constraints = 0;                       ///< degree of over-constraint with actuators held
  std::optional<Assembly> assembly;                    ///< where legs stand beside their seats
  std::optional<FloatingPlay> floating;
  std::vector<std::string> rigid_motions;  ///< along which the stiffness is infinite; K is that of the others
  std::vector<std::string> notes;  ///< what the MSA held or found poor: idle spins, redundant constraints, conditioning
  LineMesh mesh;                   ///< the MSA's structure
  FieldData fields;                ///< on it: displacements, member forces
};

}  // namespace deflect
