// Degree of static indeterminacy.
#pragma once

#include "msa/mechanism/configuration.h"

namespace deflect::analytic {

/// The number of internal forces that equilibrium does not determine. This is the number of dimensions that must fit
/// for assembly without strain. Summed over the legs, and likewise over the branches of every part with branches:
///   Σ dim N_i − rank[N_1 … N_n],
/// with N_i the wrenches that branch i carries, where actuators are held and elastic freedoms count as rigid. Joints
/// and laws in parallel with the legs or with a joint constrain only where they are rigid: their elastic freedoms count
/// as free. 0 for a serial arm.
int redundant_constraints(const Configuration&);

}  // namespace deflect::analytic
