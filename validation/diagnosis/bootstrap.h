// How often chance alone would look like an effect: a parametric bootstrap of the null.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "validation/diagnosis/signatures.h"
#include "validation/parallel/work.h"

namespace deflect::diagnosis {

/// Told how many of all pieces of work are done, from any thread.
using Counted = std::function<void(std::size_t done, std::size_t all)>;

/// Chance that in `sets` drawn data with nothing missing some effect looks at least as good (as improbable) as
/// `least_p`. Of such data r ~ N(0, 1), whitened, all that matters are the components along the signatures, z = Bᵀr ~
/// N(0, BᵀB). The same for any number of threads and ranks; not below 1/(sets + 1), to which it is resolved.
double chance_of_any(const std::vector<Signature>&, double least_p, int sets, const parallel::Work&,
                     const Counted& = {});

}  // namespace deflect::diagnosis
