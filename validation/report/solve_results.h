// One pose and one load as JSON, by the contract of `solve --json`, and as a report for a person.
#pragma once

#include <string>

#include "validation/studies/solve.h"

namespace deflect::report {

/// {"pose", "load", "theories": [{"name", "title"}, …], of each theory under its name {"displacement",
/// "stiffness"}, "relative_difference" where there are several,
/// "checks", "shares": [{"part", "share"}, …] as in the result}; mm, rad, N, Nmm, deg. In the deformed shape also
/// "geometry" and of each theory "from_linear", and no check of passive joints. Throws NumericalError naming a number
/// that is not finite.
std::string solve_json(const studies::SolveResult&);

/// Pose, load, displacement by each theory, the reference's stiffness and how far the others are from it,
/// shares from the largest down, checks.
std::string solve_report(const studies::SolveResult&);

}  // namespace deflect::report
