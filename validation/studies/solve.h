// One pose, one load, every theory: what `deflect solve` reports.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "msa/mechanism/stand.h"
#include "validation/theories/theory.h"

namespace deflect::studies {

/// What one theory says of the tool point T, in base axes.
struct TheorySolution {
  Vector6 displacement_mm_rad = Vector6::Zero();  ///< ux uy uz (mm), thx thy thz (rad)
  Matrix6 stiffness_mm = Matrix6::Zero();         ///< wrench (N, Nmm) per displacement: N/mm, N, Nmm
  /// By how much the displacement in the deformed shape differs from the linear one, relative_difference().
  double from_linear = 0;
};

/// The mechanism assembled with its misfits, without load and weight.
struct Assembly {
  std::vector<Vector6> offsets_mm_rad;                              ///< by theory: T beside its place in the drawing
  std::vector<std::pair<std::string, Vector6>> leg_wrenches_N_Nmm;  ///< platform on leg, at T
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
  theories::Theories theories;
  std::vector<TheorySolution> solutions;  ///< by theory
  double relative_difference = 0;         ///< of the displacements, see relative_difference(); the largest of any two
  /// Finite: about what dividing members leaves of relative_difference, of the theories together.
  double discretisation = 0;
  /// Checks of the stiffness by all theories; the last one of linear geometry only.
  bool symmetric = true, positive = true, passive_joints_free = true;
  std::vector<std::pair<std::string, double>> shares;  ///< part, its share of the strain energy
  std::vector<JointValue> joints;                      ///< commanded coordinates
  int redundant_constraints = 0;                       ///< degree of over-constraint with actuators held
  std::optional<Assembly> assembly;                    ///< where legs stand beside their seats
  std::optional<FloatingPlay> floating;
  std::vector<std::string> rigid_motions;  ///< along which the stiffness is infinite; K is that of the others
  std::vector<std::string> notes;  ///< what was held or found poor: idle spins, redundant constraints, conditioning
  LineMesh mesh;                   ///< the structure, of a theory that has one
  FieldData fields;                ///< on it: displacements, member forces

  /// By the theory that is shown where one must do (reference_of).
  const TheorySolution& reference() const { return solutions[theories::reference_of(theories)]; }
};

/// The theories at one pose under one wrench (N, Nmm at T, base axes). Throws NumericalError naming the check where one
/// fails, where a theory does not converge and where two disagree. In the deformed shape members have at least eight
/// elements in a theory that divides them.
SolveResult solve(const Mechanism&, const Stand&, const Vector6& load_N_Nmm, const frame::MemberDivision&,
                  Geometry = Geometry::linear, const theories::Theories& = theories::all_theories());

}  // namespace deflect::studies
