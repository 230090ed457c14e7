// What each erratum of the paper costs: the closed form as printed against the corrected one.
#pragma once

#include <string>
#include <vector>

#include "analytic/model.h"
#include "validation/studies/validate.h"

namespace deflect::studies {

/// The price of one erratum: deflection along the load as printed / corrected at the points, smallest and largest ratio
/// for loads along x, y, z. `refused` says why there is no number where the variant has no solution somewhere.
struct ErratumPrice {
  Erratum erratum;
  Vector3 smallest, largest;
  std::string failed_check;  ///< of the stiffness as printed, at the first point where one fails; may be empty
  std::string refused;
};
std::vector<ErratumPrice> price_errata(const Mechanism&, const std::vector<ValidationPoint>&, double load_N);

/// The closed form as printed under a wrench. NumericalError where it has no equilibrium.
analytic::AnalyticSolution solved_as_printed(const analytic::AnalyticModel& printed, const Vector6& F_T_W);

}  // namespace deflect::studies
