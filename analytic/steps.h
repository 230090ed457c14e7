// Laws that jump, and those that bend beside them, by phases: in each the deflection is affine in the force, or the
// force is known and the deflection is what the structure around asks for (released). With forces the unknowns of a
// chain, a phase is
//
//   one-sided  pull, push   δ = c f
//   clearance  +, −         δ = ±gap
//              open         f = 0, |δ| ≤ gap
//   friction   sticks       δ = slip + f/k, |f| ≤ F
//              slides ±     f = ±F, the slip moves that way
//   one that   bends        δ by its tangent at f, where that is known
//   bends
//
// A preloaded law carries f + P where the joint transmits f, and δ counts from its state at P.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "msa/base/spatial.h"
#include "msa/mechanism/law_table.h"

namespace deflect::analytic {

/// δ = offset + compliance · f in the present phase; released: the offset is imposed, and found so that f is the known
/// one.
struct Step {
  double offset = 0, compliance = 0;
  bool released = false;
};

/// One law that jumps. `number` is its place among the steps of its mechanism.
struct SteppedLaw {
  Law law;
  double preload = 0;
  bool rotation = false;
  std::string part;
  int number = -1;

  /// By the force alone: friction sticks at no slip.
  Step at_force(double f) const;
  /// Of the work done from the preloaded state, what is stored. J.
  double stored_energy(double f, const Step&) const;
};

/// What a mechanism answers to steps: the force in each law, the displacement of T, and the largest force at all; of a
/// rotation times `length`.
struct SteppedForces {
  VectorX forces;
  Vector6 displacement;
  double largest = 0, length = 1;
  bool converged = true;
};
using AskSteps = std::function<SteppedForces(const std::vector<Step>&)>;

/// How forces and displacement fall with offsets that are imposed on all laws, each in series with a compliance c that
/// keeps them finite: f = f0 − S o. Where all other laws are linear it is the same for all loads.
struct Imposed {
  VectorX c;
  MatrixX S, T;  ///< by law; T: displacement of T per offset
};

struct BalancedSteps {
  std::vector<Step> steps;
  std::vector<double> slips;  ///< of the frictions, by FrictionLaw::number
  VectorX offsets;            ///< imposed on the laws beside the compliances of Imposed; empty where not converged
  bool converged = false;
  std::string reason;  ///< where there is no equilibrium, or none was found
  /// Parts whose play nothing loads. The steps are the middle of the play (set_valued_laws.h); T moves in it by
  /// `twists` (columns), by between `least` and `most` along each axis.
  std::vector<std::string> loose;
  Matrix6X twists = Matrix6X(6, 0);
  Vector6 least = Vector6::Zero(), most = Vector6::Zero();
};

/// The steps in which every law agrees with its force. Forces and deflections of the laws are the least values of a
/// convex function (set_valued_laws.h), as the forces fall with the offsets; where laws that are no steps bend they are
/// linearised about the last offsets until they agree. `slips` before the load. `imposed`: of this mechanism, if it is
/// known; it is found where it is empty.
BalancedSteps balance(const std::vector<SteppedLaw>&, const std::vector<double>& slips, const AskSteps&,
                      Imposed& imposed);

}  // namespace deflect::analytic
