// How often chance alone looks like an effect: a parametric bootstrap of the null hypothesis.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "validation/diagnosis/candidates.h"
#include "validation/parallel/work.h"

namespace deflect::diagnosis {

/// Progress callback, called from any thread with the number of tasks done and of all tasks.
using Counted = std::function<void(std::size_t done, std::size_t all)>;

/// Probability that, with nothing missing, some effect reaches a p-value of at most `least_p`, from `sets` simulated
/// data sets. The whitened residual is then r ~ N(0, 1), and only its components along the signatures matter, z = Bᵀr ~
/// N(0, BᵀB). `inner`: BᵀB, the signatures' inner_products(). The result does not depend on the number of threads and
/// ranks, nor on which of the sets a journal held. Its resolution and least value are 1/(sets + 1).
double chance_of_any(const std::vector<Signature>&, const MatrixX& inner, double least_p, int sets,
                     const parallel::Work&, const Counted& = {});

/// The least p-value of candidates alone, in the order of their signatures, divided by their weights.
double least_p_value(const std::vector<Signature>&, const std::vector<Candidate>&);

/// p-value of a gain in χ² as if this were the only effect tested.
double single_p_value(const Signature&, double gain);

/// The gain with this p-value; 0 where every gain has a smaller p-value.
double gain_at_p_value(const Signature&, double p);

}  // namespace deflect::diagnosis
