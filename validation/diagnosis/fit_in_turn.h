// Fits many candidates in groups, the most promising first, so that few are fitted in vain.
#pragma once

#include <algorithm>
#include <map>
#include <vector>

#include "msa/base/index.h"
#include "validation/parallel/cases.h"

namespace deflect::diagnosis {

inline constexpr double far_behind = 6;  // what is sure to be less likely than the best by this logarithm is not fitted
/// Fits that are begun together: first one, then twice as many each time, up to this. The next ones are compared with
/// the best of these, so that one that explains nearly all spares most others. The numbers do not depend on the
/// threads, so that the answer does not.
inline constexpr std::size_t at_once = 8;
/// Fits those signatures that can still come near the best, which promise the most first. `promise` returns the most
/// that ln of the odds of a signature's class can become by its fit; it may learn from the fits so far, of which
/// `fitted` is told. `fit_one`, given the signature and the number of threads within, returns ln of the odds found.
/// Returns the bar that further ones must exceed.
template <class Promise, class FitOne, class Fitted>
double fit_in_turn(std::vector<std::size_t> all, double bar, int threads, const Promise& promise, const FitOne& fit_one,
                   const Fitted& fitted) {
  for (std::size_t count = 0; !all.empty();) {
    std::map<std::size_t, double> most;
    for (const std::size_t i : all) most[i] = promise(i);
    std::erase_if(all, [&](std::size_t i) { return !(most[i] > bar); });
    std::stable_sort(all.begin(), all.end(), [&](std::size_t a, std::size_t b) { return most[a] > most[b]; });
    count = std::min({std::max<std::size_t>(1, 2 * count), at_once, all.size()});
    // Where few are fitted, one with many starts would keep one thread busy long after the others.
    const int within = count < at_once ? threads : 1;
    parallel::for_each_case(count, 1, threads, [&](std::size_t k) { fit_one(all[k], within); });
    for (std::size_t k = 0; k < count; ++k) bar = std::max(bar, fitted(all[k]) - far_behind);
    all.erase(all.begin(), all.begin() + as_index(count));
  }
  return bar;
}

}  // namespace deflect::diagnosis
