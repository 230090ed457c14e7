// Which of many candidates are fitted, and in which order: those that promise the most first, until none can come near
// the best of those that are fitted.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "msa/base/index.h"
#include "validation/diagnosis/hypothesis.h"
#include "validation/diagnosis/signatures.h"
#include "validation/parallel/cases.h"

namespace deflect::diagnosis {

inline constexpr double near_nothing = 6;  // gain in χ² that is not looked into
inline constexpr double bent = 8;          // that a fit may gain beyond what the signature says, where small
inline constexpr double far_behind = 6;  // what is sure to be less likely than the best by this logarithm is not fitted
/// Fits that are begun together: first one, then twice as many each time, up to this. The next ones are compared with
/// the best of these, so that one that explains nearly all spares most others. The numbers do not depend on the
/// threads, so that the answer does not.
inline constexpr std::size_t at_once = 8;
inline constexpr double certain = 1e9;
inline constexpr double out_of_question = -1e9;  // ln of the odds of what is there already, or cannot be

/// Fits those signatures that can still come near the best, which promise the most first. `promise` returns the most
/// that ln of the odds of a signature's class can become by its fit; it may learn from the fits so far, of which
/// `fitted` is told. `fit_one`, given the signature and the number of threads within, returns ln of the odds found.
/// Returns the bar that further ones must exceed. `share_behind`: of the best odds, how far behind is too far, if that
/// is more than far_behind.
template <class Promise, class FitOne, class Fitted>
double fit_in_turn(std::vector<std::size_t> all, double bar, int threads, const Promise& promise, const FitOne& fit_one,
                   const Fitted& fitted, double share_behind = 0) {
  for (std::size_t count = 0; !all.empty();) {
    std::map<std::size_t, double> most;
    for (const std::size_t i : all) most[i] = promise(i);
    std::erase_if(all, [&](std::size_t i) { return !(most[i] > bar); });
    std::stable_sort(all.begin(), all.end(), [&](std::size_t a, std::size_t b) { return most[a] > most[b]; });
    count = std::min({std::max<std::size_t>(1, 2 * count), at_once, all.size()});
    // Where few are fitted, one with many starts would keep one thread busy long after the others.
    const int within = count < at_once ? threads : 1;
    parallel::for_each_case(count, 1, threads, [&](std::size_t k) { fit_one(all[k], within); });
    for (std::size_t k = 0; k < count; ++k) {
      const double odds = fitted(all[k]);
      bar = std::max(bar, odds - std::max(far_behind, share_behind * odds));
    }
    all.erase(all.begin(), all.begin() + as_index(count));
  }
  return bar;
}

/// Physics lets it act to one side only, and the residual asks for the other.
inline bool wrong_way(const Signature& s, const VectorX& residual) {
  return !s.shaped && s.one_sided && s.start_along(residual) > 0;
}

/// Of one parameter with a value at which it vanishes: its signature is that of a small size.
inline bool has_one_size(const Signature& s) {
  const std::vector<effects::EffectParameter>& all = s.effect.effect->parameters;
  return !s.shaped && all.size() == 1 && all.front().vanishes;
}

/// What a fit may gain where the signature says so much: little more where one law at a place is nearly proportional.
/// A few shapes of a law that bends say less, and how much less is alike at all places of that law: once it is fitted
/// at one place, as much more is expected of the others.
class CanGain {
 public:
  double operator()(const Signature& s, double said) const {
    if (!s.shaped) return s.effect.effect->place ? 1.1 * said + 3 : 1.2 * said + bent;
    const auto of_law = times_.find(law_of(s.effect));
    return (of_law == times_.end() ? usual : std::max(usual, of_law->second)) * said + bent;
  }

  void note(const Signature& s, double said, double gained) {
    if (!s.shaped || said < near_nothing) return;
    double& most = times_[law_of(s.effect)];
    most = std::max(most, (gained - bent) / said);
  }

 private:
  static constexpr double usual = 1.2;
  std::map<std::string, double> times_;
};

}  // namespace deflect::diagnosis
