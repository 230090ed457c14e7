// Degree of static indeterminacy.
#pragma once

#include "msa/mechanism/configuration.h"

namespace deflect::analytic {

/// How many internal forces equilibrium leaves open, which is how many dimensions must fit for the mechanism to be
/// assembled without strain: over the legs, and in the same way over the branches of every part that has branches,
///   Σ dim N_i − rank[N_1 … N_n],
/// N_i the wrenches that branch i carries with actuators held and elastic freedoms in place; those of a leg beside the
/// others only where it is rigid. 0 of a serial arm.
int redundant_constraints(const Configuration&);

}  // namespace deflect::analytic
