// Where in the subject the unexplained rest of the misfit acts.
//
// A place is judged by all its laws together (at_places.h). What no place explains makes them harder to tell apart:
// gains are divided by s = max(1, χ² left by the best place over the numbers left).
#pragma once

#include <string>
#include <vector>

#include "validation/diagnosis/at_places.h"

namespace deflect::diagnosis {

struct Localised {
  effects::PlacedEffect effect;  ///< of the laws at the place the one that explains most
  std::string what;              ///< "the actuator rx of every leg yields like a spring"
  double share = 0;              ///< of χ² beyond noise and tolerances that the place can explain beside the fit
  double probability = 0;        ///< that it acts there and at no other place
};

/// The places for the residual of a fit with that χ² of `numbers` measured numbers, the most probable first, until they
/// have 95 % of the probability together, at most `most`. Empty where none reduces χ² clearly more than chance (by 30).
std::vector<Localised> localised(const std::vector<AtPlace>&, double chi2, double numbers, std::size_t most = 3);

}  // namespace deflect::diagnosis
