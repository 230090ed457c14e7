// What data do not determine: directions in the space of the parameters along which the readings change by less than
// their noise.
//
// With J the derivative of the whitened residual with respect to the coordinates over their scales, J = U S Vᵀ, a step
// along column v of V is known to the standard deviation 1/S. A direction with 1/S > 1/2 is not determined: in ln p
// that is a factor of e between the ends of the 95 % interval and the middle.
#pragma once

#include <string>
#include <vector>

#include "validation/fit/free_parameters.h"

namespace deflect::fit {

struct Undetermined {
  VectorX direction;     ///< by parameter, unit length; scaled coordinates
  double deviation = 0;  ///< standard deviation of a step along it; infinite where nothing resists
  std::string sentence;  ///< "only the product of A and B is determined …"
};

/// The worst determined first.
std::vector<Undetermined> undetermined(const MatrixX& J, const std::vector<FreeParameter>&, const VectorX& values);

}  // namespace deflect::fit
