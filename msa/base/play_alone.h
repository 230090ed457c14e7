// Slack between two ends that no other law moves: where row and column of a law in P are those of the identity,
// s = d0/c whatever the laws do, and d follows from s alone. In a mechanism with as many parts as it needs to stand all
// slack is such, and there is nothing to search.
#pragma once

#include <vector>

#include "msa/base/set_valued_laws.h"

namespace deflect {

/// As solve(), which it calls for all laws that others move.
SetValuedSolution solve_apart(const LinearRelation&, const std::vector<ScalarLaw>&, const MatrixX& watched);

}  // namespace deflect
