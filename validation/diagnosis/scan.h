// The systematic scan: every direction of every joint, of base and tool, with every law that it may follow, in all legs
// or in one, whether an entry of the catalogue is about it or not. It localises what no entry explains.
#pragma once

#include <string>
#include <vector>

#include "validation/diagnosis/hypothesis.h"

namespace deflect {

struct Localised {
  std::string what;  ///< "actuator rx of every leg, like a spring"
  double share = 0;  ///< of χ² beyond noise and tolerances that it can take off, beside what is fitted
};

/// The best, sorted, of a residual that a fit leaves; of those that do all but the same the first. Empty where nothing
/// takes off more than chance.
std::vector<Localised> scan(const Observations&, const Fit&, int threads, std::size_t most = 3);

}  // namespace deflect
