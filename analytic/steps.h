// Laws that jump, by phases: in each the deflection is affine in the force, or the force is known and the deflection is
// what the structure around asks for (released). With forces the unknowns of a chain, a phase is
//
//   one-sided  pull, push   δ = c f
//   clearance  +, −         δ = ±gap
//              open         f = 0, |δ| ≤ gap
//   friction   sticks       δ = slip + f/k, |f| ≤ F
//              slides ±     f = ±F, the slip moves that way
//
// A preloaded law carries f + P where the joint transmits f, and δ counts from its state at P.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "msa/base/spatial.h"
#include "msa/mechanism/law.h"

namespace deflect::analytic {

/// δ = offset + compliance · f in the present phase; released: the offset is imposed, and found so that f is the known
/// one. open: f = 0, which a chain side by side with others can keep by itself.
struct Step {
  double offset = 0, compliance = 0;
  bool released = false, open = false;
};

/// One law that jumps. `number` is its place among the steps of its mechanism.
struct SteppedLaw {
  Law law;
  double preload = 0;
  bool rotation = false;
  int number = -1;

  /// By the force alone: friction sticks at no slip.
  Step at_force(double f) const;
  /// Of the work done from the preloaded state, what is stored. J.
  double stored_energy(double f, const Step&) const;
};

/// What a mechanism answers to steps: the force in each law, and the largest force at all, against which a law is
/// loaded or not; of a rotation times `length`.
struct SteppedForces {
  VectorX forces;
  VectorX motions;  ///< δ of laws whose force was kept at 0 by releasing them; not a number: of the others
  double largest = 0, length = 1;
  bool converged = true;
};

struct BalancedSteps {
  std::vector<Step> steps;
  std::vector<double> slips;  ///< of the frictions, by FrictionLaw::number
  bool converged = false;
  std::string reason;  ///< where there is no equilibrium, or none was found
};

/// Phases in which no law contradicts itself: those that do change phase together, after some rounds one in a round and
/// another one to begin with each time, so that none returns for ever. A clearance crosses over at first and opens
/// where that does not settle. The offsets of released laws are found by Newton on their forces; forces that no offset
/// changes follow from equilibrium alone: a clearance closes on their side, a friction that is overcome has no
/// equilibrium. `slips` before the load.
BalancedSteps balance(const std::vector<SteppedLaw>&, const std::vector<double>& slips,
                      const std::function<SteppedForces(const std::vector<Step>&)>&);

}  // namespace deflect::analytic
