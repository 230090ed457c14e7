// Slack between two ends that no other law moves: where row and column of a law in P are those of the identity,
// s = d0/c whatever the laws do, and d follows from s alone. In a mechanism with as many parts as it needs to stand all
// slack is such, and there is nothing to search.
#pragma once

#include <vector>

#include "msa/base/set_valued_laws.h"

namespace deflect {

/// As solve(), to which it leaves all other laws. Results are the same to rounding, except that a law which counts as
/// unloaded keeps its s = d0/c. For the closed form, which asks thousands of times. The MSA asks solve(): its search
/// has cases in which rounding decides whether it ends, and they end with that.
SetValuedSolution solve_apart(const LinearRelation&, const std::vector<ScalarLaw>&, const MatrixX& watched);

}  // namespace deflect
