// One pose and one load as JSON, by the contract of `solve --json`, and as a report for a person.
#pragma once

#include <string>

#include "validation/theories/solve_result.h"

namespace deflect {

/// {"pose", "load", "analytic": {"displacement", "stiffness"}, "msa": {the same}, "relative_difference",
/// "checks", "shares": [{"part", "share"}, …] as in the result}; mm, rad, N, Nmm, deg. In the deformed shape also
/// "geometry" and of each theory "from_linear", and no check of passive joints. Throws NumericalError naming a number
/// that is not finite.
std::string solve_json(const SolveResult&);

/// Pose, load, displacement by both theories, the MSA's stiffness and how far the analytic one is from it,
/// shares from the largest down, checks.
std::string solve_report(const SolveResult&);

}  // namespace deflect
