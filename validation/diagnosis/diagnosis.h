// Which physical effect is missing: every effect of a catalogue, at every place it has in the device, is fitted to the
// residual with all tolerances free under their priors; the evidence decides, and says when it cannot.
//
// Detection: the best effect must beat what the best of all effects reaches by chance in data with nothing missing.
// Selection: prior · evidence (evidence.h), effects that do the same to these data sharing one prior. Further effects
// are added as long as they are called for, each refitted with those before; one that the others make needless is
// dropped again. What is left is tested against a structured discrepancy made of all patterns of `compare`.
#pragma once

#include <string>
#include <vector>

#include "validation/diagnosis/hypothesis.h"
#include "validation/diagnosis/signatures.h"

namespace deflect {

enum class Verdict { nothing_missing, effect, ambiguous, unknown_effect };
inline constexpr const char* verdict_names[] = {"nothing_missing", "effect", "ambiguous", "unknown_effect"};

/// One hypothesis looked at.
struct Candidate {
  Hypothesis hypothesis;  ///< with the effects found before it, if any, in front
  Fit fit;
  double gain = 0;  ///< in χ² over what was found before
  double probability = 0;
  double rmse = 0, held_out = 0;  ///< m
  double chi2_per_dof = 0;

  const PlacedEffect& added() const { return hypothesis.back(); }
};

/// How well a state of the device describes the data.
struct Quality {
  double rmse = 0, held_out = 0, chi2_per_dof = 0;  ///< m, m
};

/// What this campaign would show of an effect.
struct Detectable {
  PlacedEffect effect;
  double lambda_at_start = 0;    ///< norm of its signature at the start values
  std::vector<double> smallest;  ///< values at which λ = 4; empty where they are outside the bounds
  std::string mistaken_for;      ///< the entry that is most like it, where the cosine is above 0.9
  double cosine = 0;
};

struct Diagnosis {
  Verdict verdict = Verdict::nothing_missing;
  double probability_nothing = 0, probability_unknown = 0;
  double chance = 1;                  ///< of any effect looking as good with nothing missing
  std::vector<Candidate> candidates;  ///< of the first step, best first
  Hypothesis missing;                 ///< in the order in which they were added
  Fit fit;                            ///< of all of them
  std::vector<std::vector<std::string>> indistinguishable;
  Quality baseline, final;
  double noise_floor = 0;  ///< m: σ of a reading
  bool unexplained = false;
  double share_unexplained = 0;                          ///< of the misfit beyond noise and tolerances
  std::string pattern;                                   ///< of what is left
  std::string nearest;                                   ///< entry that comes nearest to what is left
  std::vector<std::pair<std::string, double>> strained;  ///< tolerances beyond two deviations at the end
  std::vector<Detectable> detectable;
};

struct DiagnosisOptions {
  ComparisonOptions comparison;
  int threads = 0;
  std::function<void(std::size_t done, std::size_t all)> progress;
};

/// The effects must outlive the result.
Diagnosis diagnose(const Mechanism&, const Measurements&, const std::vector<Effect>&, const DiagnosisOptions& = {});

}  // namespace deflect
