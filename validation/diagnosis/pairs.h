// Two effects at once, by their signatures.
//
// Effects that are added one after the other may begin with one that is like the sum of two and is neither of them.
// Where each of two has the same λ, any third whose cosine with their sum is above 0.71 looks better than both alone.
// So all pairs are compared as well: by how much they reduce χ² together, linear in their amplitudes.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "validation/diagnosis/signatures.h"

namespace deflect::diagnosis {

/// Two signatures, the one that explains more alone first.
struct PairOfSignatures {
  std::size_t first = 0, second = 0;
  double gain_of_first = 0, gain = 0;  ///< in χ²: of the first alone, of both
};

/// The best pairs beside what is fitted already, best first, at most `most`.
///   between   inner_products() of the signatures
///   beside    orthonormal columns of what is fitted
///   log_odds  ln(prior · evidence) of one signature with a gain in χ²; of a pair it is the sum over the first with its
///             own gain and the second with the rest. Not more than ln 2 + half of the gain beyond that without a gain.
///   least     pairs with less are not told
/// A signature that is there already (less than a twentieth of it outside of `beside`) or explains next to nothing
/// alone (6 in χ²) is in no pair; nor are two of which one has less than a twentieth outside of the other.
std::vector<PairOfSignatures> best_pairs(const std::vector<Signature>&, const MatrixX& between, const VectorX& residual,
                                         const MatrixX& beside,
                                         const std::function<double(std::size_t, double)>& log_odds, double least,
                                         std::size_t most);

}  // namespace deflect::diagnosis
