// Where in the subject the unexplained rest of the misfit acts: the laws at places that would explain most of it.
#pragma once

#include <string>
#include <vector>

#include "validation/diagnosis/signatures.h"

namespace deflect::diagnosis {

struct Localised {
  effects::PlacedEffect effect;
  std::string what;  ///< "the actuator rx of every leg yields like a spring"
  double share = 0;  ///< of χ² beyond noise and tolerances that it can explain in addition to the fit
};

/// The best laws for the residual of a fit to `numbers` measured numbers, best first; of laws that are almost
/// indistinguishable only the first. Empty where none reduces χ² clearly more than chance (by 30).
std::vector<Localised> localised(const std::vector<Signature>&, const Fit&, double numbers, std::size_t most = 3);

}  // namespace deflect::diagnosis
