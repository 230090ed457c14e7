// Equilibrium of a mechanism in its displaced shape: second-order or finite geometry (msa/base/geometry.h), by chains
// of virtual joints (virtual_chain.h).
//
// Loads are dead: force and moment constant in base axes, the moment conjugate to the spin of the tool. Newton's method
// applies the misfits first, then the load. A step is halved where the iteration fails, where it ends in an unstable
// equilibrium (some part of the mechanism could move by itself), and where it converges so slowly that it may have left
// the path of equilibria (below). So the answer is always the state to which the growing load leads. Beyond the first
// buckling or limit load there is no answer, and load_factor is the share of the load where this happens. In second
// order the forces of the state and the displacements under them are iterated until they agree.
//
// The path counts as followed where each Newton step is at most `follows` times the one before. At a limit point (a
// fold, where K goes to zero linearly with the displacement) this ratio is ½ for a load step that ends at the fold and
// more for one beyond it; for one that covers a small share s of the remaining displacement it is about s/(2(1 − s)).
//
// Members that bend are divided into pieces in series. Their number is doubled until the estimated discretisation error
// is small: a third of the change by the last doubling, because the error falls with the square of the length of a
// piece or faster (beam_column.h).
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "analytic/laws_at_rest.h"
#include "analytic/virtual_chain.h"
#include "msa/base/geometry.h"

namespace deflect::analytic {

/// Moves the steps of laws that are held (ShapeConditions::steps) to where the laws agree with these forces in them,
/// beside the largest force in the mechanism, N.
using MoveSteps = std::function<StepsMoved(const VectorX& forces, double largest, std::vector<Step>&)>;

struct Deformed {
  VirtualChain whole;  ///< base joint, legs, tool joint; F is the outer wrench
  ShapeConditions conditions;
  MoveSteps move_steps = nullptr;         ///< asked before each step of Newton's method but the first; empty: they stay
  Vector3 translation = Vector3::Zero();  ///< of T from the drawing
  Matrix3 turning = Matrix3::Zero();      ///< finite: rotation of T, R − I
  Vector3 rotation_vector = Vector3::Zero();  ///< second order: small rotation of T
  std::vector<Vector6> leg_wrenches;          ///< about the platform's T, base axes
  bool converged = false;
  bool undecided = false;       ///< the steps did not come to rest
  bool at_dead_centre = false;  ///< where it does not converge: of the passive joints of a leg
  double load_factor = 0;       ///< share of the load that the state carries
  int iterations = 0;
  double residual = 0;                                       ///< relative change by the last step
  std::vector<int> pieces;                                   ///< of each member, in the order of for_each_part
  Eigen::Vector2d discretisation = Eigen::Vector2d::Zero();  ///< of T, m and rad: estimated discretisation error
  std::string message;                                       ///< why it did not converge
};

/// The start for any load: nothing has moved, every member is one piece. `linear`: no law's stiffness depends on its
/// force, so that the first Newton step has the same legs for every load and can reuse them.
Deformed at_rest(const Configuration&, Geometry, bool linear);
/// The same with all laws that are not linear held in these steps (hold_laws), none of them released. Throws
/// std::invalid_argument where there are not so many laws.
Deformed at_rest_in(const std::vector<Step>&, const Configuration&, Geometry);

/// The state under the wrench F at T, weight included. Where it does not converge, the last stable state found.
Deformed deform(const Deformed& rest, const Configuration&, const Vector6& F_T_W);
/// The state under the wrench that a state carries, with its laws held in other steps.
Deformed in_other_steps(const Deformed&, const std::vector<Step>&, const Configuration&);

/// What second order leaves out, as an order of magnitude relative to the displacement: the square of the largest
/// rotation of a body plus the largest strain of a member's axis.
double left_out_in_second_order(const Deformed&);

/// Tangent of a state, [f; m] at T by [δ; spin], base axes: K = J⁻ᵀ(K − H)J⁻¹ − ½[m]× with K and H of the whole chain,
/// symmetric where no outer moment m acts. Second order: K_E + K_G at the forces of the state. Throws ModelError where
/// K is infinite.
Matrix6 stiffness(const Deformed&);
Matrix6 compliance(const Deformed&);
/// The contribution of one leg, K_c, in base axes and with the base as it stands; in second order by the rotation
/// vector of T, as the wrenches of legs.
Matrix6 leg_stiffness(const Deformed&, std::size_t leg);

}  // namespace deflect::analytic
