// Where in the subject the rest acts that no effect explains: the laws at places that would take most of it off.
#pragma once

#include <string>
#include <vector>

#include "validation/diagnosis/signatures.h"

namespace deflect::diagnosis {

struct Localised {
  effects::PlacedEffect effect;
  std::string what;  ///< "the actuator rx of every leg yields like a spring"
  double share = 0;  ///< of χ² beyond noise and tolerances that it can take off, beside what is fitted
};

/// The best, sorted, of a residual of so many `numbers` that a fit leaves; of those that do all but the same the first.
/// Empty where nothing takes off more than chance.
std::vector<Localised> localised(const std::vector<Signature>&, const Fit&, double numbers, std::size_t most = 3);

}  // namespace deflect::diagnosis
