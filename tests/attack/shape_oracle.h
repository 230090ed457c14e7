// Equilibrium of a device in its deformed shape, by neither theory: all bodies, joints and rods in space, their statics
// written where they then stand, in extended precision.
//
// Between bodies in which legs meet run chains (shape_chain.h). Unknown are the motions of the bodies, the wrench that
// passes through each chain and the numbers of its joints. Each chain must end where its body stands, each joint carry
// what statics put on it, and each body be in balance: dead forces and moments at T where it then is. These equations
// have nothing of a stiffness, of an element or of small displacements. They are solved by Newton's method, misfits
// first, then the load in steps. The determinant of its matrix changes its sign where an equilibrium loses its
// stability, so that a state with the sign of the machine at rest is the one to which the growing load leads, unless
// two motions lose it in one step.
//
// Rods are divided into twice as many steps until that changes the displacement by less than 1e-7, of
// which their fourth order leaves a fifteenth.
//
// In the matrix, not in the equations, free motions have a small stiffness and chains a small compliance: what idles
// stays, and what is held twice shares by them.
#pragma once

#include "tests/attack/shape_rod.h"

namespace deflect::attack {

struct ShapeTruth {
  bool regular = true;  ///< at rest no pivot of its matrix is below 1e-7 of the largest: nothing idles, nothing is
                        ///< held twice, and signs of determinants are certain
  bool found = false;   ///< equilibrium under the whole load
  bool stable = true;   ///< no motion lost its stability on the way
  double carried = 0;   ///< the share of the load on the way
  double left = 0;      ///< about what the steps along rods leave, relative
  Vector6 displacement = Vector6::Zero();  ///< of T from the assembled machine, m and rotation vector
  Matrix6 compliance = Matrix6::Zero();    ///< [δ; spin] of T by [f; m]
  Matrix6 at_rest = Matrix6::Zero();       ///< the same before misfits and load
};

/// Under the dead wrench F at T and the weight. `size`: expected displacement over the machine's size.
ShapeTruth solve_in_shape(const Configuration&, const Vector6& F, double size, Shear = Shear::as_angle);

}  // namespace deflect::attack
