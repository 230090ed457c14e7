// Laws that jump, and smooth nonlinear laws solved together with them, as phases. In a phase the deflection is affine
// in the force, or the force is known and the surrounding structure determines the deflection (released). Forces are
// the unknowns of a chain; the phases are
//
//   one-sided  pull, push   δ = c f
//   clearance  +, −         δ = ±gap
//              open         f = 0, |δ| ≤ gap
//   friction   sticks       δ = slip + f/k, |f| ≤ F
//              slides ±     f = ±F, the slip moves that way
//   one that   bends        δ by its tangent at f, where that is known; a table that remembers bends, too, from what
//   bends                   earlier loads have left in it
//
// A preloaded law carries f + P where the joint transmits f, and δ is relative to its state at P.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "msa/base/spatial.h"
#include "msa/mechanism/law.h"

namespace deflect::analytic {

/// δ = offset + compliance · f in the present phase. Released: the offset is imposed such that f has its known value.
struct Step {
  double offset = 0, compliance = 0;
  bool released = false;
  double stored = 0;  ///< by a table that remembers, J
};

/// One law that jumps. `number` is its index among the steps of its mechanism.
struct SteppedLaw {
  Law law;
  double preload = 0;
  bool rotation = false;
  std::string part;
  int number = -1;
  std::size_t freedom = 0;  ///< of the joint, tx … rz
  int leg = -1;             ///< by index; −1: base and tool
  int load = -1;            ///< of a friction with a share: the number of a law whose force is the load beside it

  /// The phase by the force alone; friction sticks with zero slip.
  Step at_force(double f) const;
  /// The stored part of the work done from the preloaded state, J.
  double stored_energy(double f, const Step&) const;
};

/// Response of a mechanism to given steps: the force in each law, the displacement of T, and the largest force.
struct SteppedForces {
  VectorX forces;
  Vector6 displacement;
  double largest = 0, length = 1;
  bool converged = true;
  double idle = 0;  ///< N: a smaller force is none, where it decides where play stands; at least 1e-9 of the largest
};
using AskSteps = std::function<SteppedForces(const std::vector<Step>&)>;

/// How forces and displacement decrease with offsets o imposed on all laws: f = f0 − S o. A compliance c in series with
/// each law keeps them finite. Where all other laws are linear this is the same for all loads.
struct Imposed {
  VectorX c;
  MatrixX S, T;  ///< by law; T: displacement of T per offset
};

struct BalancedSteps {
  std::vector<Step> steps;
  std::vector<double> slips;  ///< after the load, as in Conditions
  VectorX offsets;            ///< imposed on the laws in addition to the compliances of Imposed; empty where not
                              ///< converged
  bool converged = false;
  std::string reason;  ///< why there is no equilibrium, or why none was found
  /// The laws with unloaded play, by number. The steps are at the middle of the play (set_valued_laws.h). In it T can
  /// move by `twists` (columns), along each axis by `least` to `most`.
  std::vector<std::size_t> loose;
  bool moves = false;  ///< whether T moves in that play
  Matrix6X twists = Matrix6X(6, 0);
  Vector6 least = Vector6::Zero(), most = Vector6::Zero();
};

/// Finds the steps in which every law is consistent with its force. The forces decrease with the offsets, so that
/// forces and deflections of the laws minimise a convex function (set_valued_laws.h). Nonlinear laws that are not steps
/// are linearised about the last offsets until everything agrees. `slips`: before the load. `imposed`: of this
/// mechanism; computed where it is empty. `extent`: whether twists, least and most are asked for.
BalancedSteps balance(const std::vector<SteppedLaw>&, const std::vector<double>& slips, const AskSteps&,
                      Imposed& imposed, bool extent = true);

/// One round of balance(), for a mechanism that is itself solved round by round: the laws where they agree with what
/// `imposed` makes of the forces `at` at these offsets. `lacking`: by how much those forces are not theirs, of the
/// largest force.
BalancedSteps balance_about(const VectorX& offsets, const SteppedForces& at, const std::vector<SteppedLaw>&,
                            const std::vector<double>& slips, Imposed& imposed, double& lacking);

/// What balance() computes where `imposed` is empty: compliances and the response to offsets, of a mechanism without
/// load. Right for all loads where all that does not jump is linear. `unloaded`: the result of this for the mechanism
/// without load; then what offsets do in the deformed shape that answers, with the same compliances.
Imposed imposed_on(const std::vector<SteppedLaw>&, const AskSteps&, Imposed unloaded = {});

}  // namespace deflect::analytic
