// A mechanism in equilibrium with the geometry of the displaced state: second order, or finite (msa/base/geometry.h),
// by chains of virtual joints (virtual_chain.h).
//
// Loads are dead: force and moment constant in base axes, the moment conjugate to the spin of the tool. Newton's
// method; the misfits are put in place first, then the load; steps are halved where it fails, where it ends in an
// equilibrium that is not stable (some part of the mechanism could move by itself), and where it converges so slowly
// that it may have left the path of equilibria (below). So the answer is always the state that growing loads lead to;
// beyond the first buckling or limit load there is none, and load_factor says where that is. In second order the forces
// of the state and the displacements under them are iterated until they agree.
//
// Followed: Newton's steps shrink from one to the next by `follows` at least. At a limit point, a fold at which K goes
// to zero linearly with the displacement, a step that takes the share s of the displacement that is left to the fold
// has the ratio s/2(1 − s): ½ for the step to the fold itself, more for every one beyond.
//
// Members that bend are divided into pieces in series, twice as many until what that changes, over 3 (the error of a
// piece falls with the square of its length or faster, beam_column.h), is small.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "analytic/virtual_chain.h"
#include "msa/base/geometry.h"

namespace deflect::analytic {

struct Deformed {
  VirtualChain whole;  ///< base joint, legs, tool joint; F is the outer wrench
  ShapeConditions conditions;
  Vector3 translation = Vector3::Zero();      ///< of T from the drawing
  Matrix3 turning = Matrix3::Zero();          ///< of T, rotation less identity; finite
  Vector3 rotation_vector = Vector3::Zero();  ///< second order: small
  std::vector<Vector6> leg_wrenches;          ///< about the platform's T, base axes
  bool converged = false;
  double load_factor = 0;  ///< of the load that the state carries
  int iterations = 0;
  double residual = 0;                                       ///< what the last step changed, relative
  std::vector<int> pieces;                                   ///< of each member, in the order of for_each_part
  Eigen::Vector2d discretisation = Eigen::Vector2d::Zero();  ///< of T, m and rad: about what the pieces leave
  std::string message;                                       ///< why it has not converged
};

/// The beginning for any load: nothing has moved, every member is in one piece. `linear`: no law's stiffness depends on
/// its force, so that the first step of Newton's method sees the same legs whatever the load.
Deformed at_rest(const Configuration&, Geometry, bool linear);

/// The state under the wrench F at T, weight included. Not converged: the last stable state that was found.
Deformed deform(const Deformed& rest, const Configuration&, const Vector6& F_T_W);

/// Tangent of a state, [f; m] at T by [δ; spin], base axes: K = J⁻ᵀ(K − H)J⁻¹ − ½[m]× with K and H of the whole chain,
/// symmetric where no outer moment m acts. Second order: K_E + K_G at the forces of the state. Throws ModelError where
/// it is infinite.
Matrix6 stiffness(const Deformed&);
Matrix6 compliance(const Deformed&);
/// The share of one leg, base axes: K_c.
Matrix6 leg_stiffness(const Deformed&, std::size_t leg);

}  // namespace deflect::analytic
