// A fit as read back from the JSON of `deflect fit --json`.
#pragma once

#include <string>
#include <vector>

#include "validation/fit/posterior.h"

namespace deflect::fit {

/// What a prediction needs of a fit.
struct Knowledge {
  std::vector<FreeParameter> parameters;  ///< of the subject to be predicted
  VectorX values;                         ///< fitted, SI
  Posterior posterior;
  std::vector<std::string> tolerances;  ///< names of its η
  double tolerance_scale = 1;
  std::vector<Discrepancy> discrepancies;
  std::vector<std::pair<measurement::Quantity, double>> sigma;  ///< noise of a reading, SI
};

/// Of a fit of this subject, whether it has the fitted values already or those before; effects that were fitted it must
/// lack, and `effects` have. InputError "origin: member: …" for JSON that is not such a result, for parameters that the
/// subject lacks or has with other values.
Knowledge read_fit(const std::string& json, const std::string& origin, const subject::Subject&,
                   const std::vector<effects::Effect>& effects = {});

}  // namespace deflect::fit
