// How often chance alone would look like an effect: a parametric bootstrap of the null.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "validation/diagnosis/signatures.h"
#include "validation/parallel/ranks.h"

namespace deflect {

struct Bootstrap {
  int sets = 1999;  ///< drawn, of data with nothing missing
  int threads = 0;
  Ranks* ranks = nullptr;                                       ///< that share the sets; all have the result
  std::function<void(std::size_t done, std::size_t all)> told;  ///< from any thread
};

/// Chance that in data with nothing missing some effect looks at least as good (as improbable) as `least_p`. Of such
/// data r ~ N(0, 1), whitened, all that matters are the components along the signatures, z = Bᵀr ~ N(0, BᵀB). The same
/// for any number of threads and ranks; not below 1/(sets + 1), to which it is resolved.
double chance_of_any(const std::vector<Signature>&, double least_p, const Bootstrap&);

}  // namespace deflect
