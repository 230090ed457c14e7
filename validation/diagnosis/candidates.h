// Candidates for the next effect: each effect at each place, fitted together with the effects already accepted.
#pragma once

#include <functional>

#include "validation/diagnosis/hypothesis.h"
#include "validation/diagnosis/signatures.h"

namespace deflect::diagnosis {

/// One hypothesis and how well it explains the data.
struct Candidate {
  Hypothesis hypothesis;  ///< the accepted effects first, if any; the added one last
  Fit fit;                ///< where not found, the candidate is judged by its signature
  double gain = 0;        ///< in χ² over the accepted effects alone
  double log_odds = 0;    ///< ln(prior · evidence) against the accepted effects alone
  /// The same for the whole class: all fitted effects that these data cannot distinguish. Candidates are ranked by it,
  /// so that an entry registered twice changes nothing.
  double class_log_odds = 0;
  double probability = 0;
  double rmse = 0, held_out = 0;  ///< m
  double chi2_per_dof = 0;

  const effects::PlacedEffect& added() const { return hypothesis.back(); }
};

/// Two effects fitted together beside the accepted ones.
struct TwoCandidates {
  Hypothesis hypothesis;  ///< the accepted effects first; the two last
  Fit fit;
  double log_odds = 0;  ///< ln(prior · evidence) of the classes of both, against the accepted effects alone
};

class Candidates {
 public:
  /// The signatures must outlive it. progress(done, all) counts within one round.
  Candidates(const std::vector<Signature>&, int threads, std::function<void(std::size_t, std::size_t)> progress = {});

  /// Every effect added to others that are fitted already, in the order of the signatures. Fits are made only where an
  /// effect can come near the best and its log_odds can reach `least`. An effect almost indistinguishable from one of
  /// the others is not added. `known`: an effect that was fitted together with the others before; its new fit also
  /// starts from those values, so that it is no worse; what these data cannot distinguish from it is fitted too, and
  /// the same law at a group that has its place. Where a part that lets go is among the likeliest, play so wide that
  /// nothing touches, and what else says the same, is fitted beside it.
  std::vector<Candidate> beside(const Observations&, const Hypothesis&, const Fit&, double least,
                                const std::optional<effects::EffectInstance>& known = {}) const;

  /// ln(prior · evidence) of the whole class of this effect, against its absence.
  double class_log_odds_of(const effects::PlacedEffect&, double gain) const;

  /// The likeliest two effects beside others that are fitted already, if ln of their odds exceeds `least` and each of
  /// them is called for beside the other, by odds of `each`. Of all pairs those are fitted that promise most by their
  /// signatures (pairs.h, pairs.cpp).
  std::optional<TwoCandidates> two_beside(const Observations&, const Hypothesis&, const Fit&, double least,
                                          double each) const;

  /// The candidates of beside() again, those fitted anew that explain more from a larger size than the one that their
  /// signatures show; `all`, or only those that turn as they grow (signatures.h). Nullopt where none of these becomes
  /// the likeliest.
  std::optional<std::vector<Candidate>> likelier_if_larger(const Observations&, const Hypothesis&, const Fit&,
                                                           const std::vector<Candidate>&, bool all) const;
  /// The candidates of beside() no other effect again, those fitted anew that explain more from these values.
  std::vector<Candidate> fitted_again(const Observations&, const Fit&, const std::vector<Candidate>&,
                                      const std::vector<effects::EffectInstance>& from) const;
  /// The same effects; beside() then tries larger sizes too.
  Candidates in_larger_sizes() const;

  int threads() const { return threads_; }
  /// inner_products() of the signatures.
  const MatrixX& between() const { return between_; }

  static constexpr double prior_missing = 0.8, prior_unknown = 0.1;  ///< prior_unknown: as a share of prior_missing

 private:
  class Round;
  double log_odds(std::size_t i, double gain, double prior) const;
  void add_up_classes(std::vector<Candidate>&) const;

  const std::vector<Signature>& signatures_;
  int threads_;
  std::function<void(std::size_t, std::size_t)> progress_;
  MatrixX between_;
  std::vector<std::size_t> classes_;  ///< for each signature, the first that these data cannot distinguish from it
  std::vector<char> lets_go_;         ///< by signature: lets_go()
  /// The places of an entry share the entry's prior; the effects of one class have one share together.
  std::vector<double> priors_, class_priors_;
  bool larger_sizes_ = false;
};

/// Adds those that could not be fitted beside what was there, and why: each once.
void add_left_out(std::vector<LeftOut>&, const std::vector<Candidate>&);

}  // namespace deflect::diagnosis
