// Hypotheses side by side: each effect at each place, beside what is there already.
#pragma once

#include <functional>

#include "validation/diagnosis/hypothesis.h"
#include "validation/diagnosis/signatures.h"

namespace deflect::diagnosis {

/// One hypothesis looked at.
struct Candidate {
  Hypothesis hypothesis;  ///< with the effects beside it, if any, in front
  Fit fit;                ///< not found: judged by its signature
  double gain = 0;        ///< in χ² over what is beside it
  double log_odds = 0;    ///< against what is beside it alone: ln(prior · evidence)
  /// The same for all together that were fitted and do the same to these data: what is chosen by, so that an entry
  /// registered twice changes nothing.
  double class_log_odds = 0;
  double probability = 0;
  double rmse = 0, held_out = 0;  ///< m
  double chi2_per_dof = 0;

  const effects::PlacedEffect& added() const { return hypothesis.back(); }
};

class Candidates {
 public:
  /// The signatures must outlive it. progress(done, all): of one round.
  Candidates(const std::vector<Signature>&, int threads, std::function<void(std::size_t, std::size_t)> progress = {});

  /// Every effect beside others that are fitted: in the order of the signatures. Fits are made for those that can come
  /// near the best and whose log_odds can reach `least`; of two that do all but the same only one can be there.
  /// `known`: an effect that was fitted beside them before, which is not fitted worse than from those values.
  std::vector<Candidate> beside(const Observations&, const Hypothesis&, const Fit&, double least,
                                const std::optional<effects::EffectInstance>& known = {}) const;

  /// ln(prior · evidence) of all that do the same as one of the effects, against their absence.
  double class_log_odds_of(const effects::PlacedEffect&, double gain) const;

  int threads() const { return threads_; }

  static constexpr double prior_missing = 0.8, prior_unknown = 0.1;  ///< the second as a share of the first

 private:
  double log_odds(std::size_t i, double gain, double prior) const;
  void add_up_classes(std::vector<Candidate>&) const;

  const std::vector<Signature>& signatures_;
  int threads_;
  std::function<void(std::size_t, std::size_t)> progress_;
  std::vector<std::size_t> classes_;  ///< per signature the first one that does the same to these data
  /// Places of an entry share what the entry has; those of one class have one share together.
  std::vector<double> priors_, class_priors_;
};

/// Adds those that could not be fitted beside what was there, and why: each once.
void add_left_out(std::vector<LeftOut>&, const std::vector<Candidate>&);

}  // namespace deflect::diagnosis
