// One pose, one load, both theories: what `deflect solve` reports.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "meshes/line_mesh.h"
#include "msa/base/spatial.h"

namespace deflect {

/// What one theory says of the tool point T, in base axes.
struct TheorySolution {
  Vector6 displacement_mm_rad = Vector6::Zero();  ///< ux uy uz (mm), thx thy thz (rad)
  Matrix6 stiffness_mm = Matrix6::Zero();         ///< wrench (N, Nmm) per displacement: N/mm, N, Nmm
};

struct SolveResult {
  Vector6 pose_mm_deg = Vector6::Zero();  ///< x y z (mm), roll pitch yaw (deg)
  Vector6 load_N_Nmm = Vector6::Zero();   ///< on T about T in base axes: fx fy fz (N), mx my mz (Nmm)
  TheorySolution analytic, msa;
  double relative_difference = 0;  ///< of the displacements, see relative_difference() in theories.h
  bool symmetric = false, positive = false, passive_joints_free = false;  ///< checks of the stiffness
  std::vector<std::pair<std::string, double>> shares;                     ///< part, its share of the strain energy
  std::vector<std::string> notes;  ///< what the MSA held or found poor: idle spins, redundant constraints, conditioning
  LineMesh mesh;                   ///< the MSA's structure
  FieldData fields;                ///< on it: displacements, member forces
};

}  // namespace deflect
