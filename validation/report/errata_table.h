// The price of each erratum of the paper: deflection as printed / corrected.
#pragma once

#include <string>
#include <vector>

#include "validation/studies/errata_prices.h"

namespace deflect::report {

/// Aligned text for a person: name, equations, range of the ratio for loads along x, y, z, what fails.
std::string errata_table(const std::vector<studies::ErratumPrice>&);

/// Columns erratum, equations, ratio_x_min … ratio_z_max, failed_check, refused.
std::string errata_csv(const std::vector<studies::ErratumPrice>&);

}  // namespace deflect::report
