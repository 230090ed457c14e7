// Whether two theories that share no stiffness formula say the same: the check that a wrong number does not survive.
#pragma once

#include <string>

#include "validation/theories/at_pose.h"

namespace deflect {

/// How far two answers to one wrench are apart, each measured by the size of the whole: displacements
/// |(δ, ℓθ)_a − (δ, ℓθ)_b| / |(δ, ℓθ)_b| with the structure's length ℓ (m), stiffnesses by their largest entry, moments
/// over ℓ. 0 where both vanish. `play`: the ends of play that nothing loads, by the size of the play and the
/// displacement; infinite where but one of them is.
struct Difference {
  double displacement = 0, stiffness = 0, play = 0;
  double largest() const;
};
Difference difference(const Answer& a, const Answer& b, double length);

/// How far they may be apart: 1e-9 where all laws are linear, 1e-7 where contacts are solved to equilibrium; more where
/// the structure amplifies the rounding of its own numbers, by `rounding` (Solver::rounding()).
double agreement_bound(bool linear, double rounding);

/// Throws NumericalError where they are further apart: it says by how much, both displacements, and what is known of
/// the cause. `where` begins the message.
void require_agreement(const Answer& analytic, const Answer& msa, double length, double bound,
                       const std::string& where);

}  // namespace deflect
