// The displacement of a device's tool point and whether it can stand, by the force method in 50 digits.
//
// Unknowns are forces. Between bodies in which legs meet (platform, base, both ends of stages in parallel) run chains
// of joints and members. All wrenches are taken at T in base axes. A chain transmits a wrench w that does no work on
// its free freedoms: w = Q q. Its flexibility is C = Σ Xᵀ c X over its joints and members, where X takes a wrench at T
// to the part's own axes and place and c is the part's flexibility there (members: dense_oracle.h).
//   Equilibrium of all bodies:  A q = f.
//   Displacement of T under unit wrenches (unit load theorem):  D = q̄ᵀ F q,  F = diag(Qᵀ C Q), where q = q̄ + S s,
//   S spans the self-equilibrated forces (A S = 0) and s makes the complementary energy least: Sᵀ F (q̄ + S s) = 0.
// The platform is held ⇔ every wrench at T finds equilibrium. That depends on geometry alone. Directions in which D is
// zero are held rigidly. Bodies inside a chain that move without moving its ends are idle.
//
// Geometry comes from configure() in doubles; a pivot of equilibrium below 1e-10 (lengths over the device's size) is
// zero, and devices with a pivot between 1e-13 and 1e-7 are told apart (`clear` is false): nobody can judge them.
#pragma once

#include "msa/mechanism/configuration.h"

namespace deflect::attack {

struct DeviceTruth {
  bool held = true;                       ///< every wrench at T finds equilibrium
  bool clear = true;                      ///< no rank was decided by a narrow margin
  int rigid_directions = 0;               ///< of T, in which nothing yields
  int idle = 0;                           ///< freedoms of bodies inside chains that move nothing else
  Matrix6 flexibility = Matrix6::Zero();  ///< D, SI
  Matrix6 stiffness = Matrix6::Zero();    ///< its inverse, where nothing is rigid
  /// The larger of T's and the softest part's flexibility times the stiffness of the stiffest part, rotations weighed
  /// by the size: by how much rounding of an assembled stiffness may grow.
  double condition = 1;
};

/// Linear laws only.
DeviceTruth solve_by_forces(const Configuration&);

}  // namespace deflect::attack
