// Which physical effect is missing. Every effect of a catalogue, at every place it has in the device, is fitted to the
// residual with all tolerances free under their priors. The evidence decides, or shows that the data cannot.
//
// Recording mistakes come first (plausibility.h): where one is certain, no effect is looked for, unless the option
// as_recorded is set (ComparisonOptions).
//
// Detection: the best effect must beat what the best of all effects reaches by chance in data with nothing missing.
// Selection: by prior · evidence (evidence.h). Effects that these data cannot distinguish share one prior. Further
// effects are added as long as the evidence supports them (selection.h).
// Remainder: what is left is tested against a structured discrepancy made of all patterns of `compare`. Where the
// discrepancy wins, something unknown is missing, and an effect is still reported as missing only where the evidence
// supports it in addition to the discrepancy.
#pragma once

#include <string>
#include <vector>

#include "validation/diagnosis/at_places.h"
#include "validation/diagnosis/candidates.h"
#include "validation/diagnosis/detectable.h"
#include "validation/diagnosis/splitting.h"
#include "validation/parallel/ranks.h"

namespace deflect::diagnosis {

enum class Verdict { nothing_missing, effect, ambiguous, unknown_effect };
inline constexpr const char* verdict_names[] = {"nothing_missing", "effect", "ambiguous", "unknown_effect"};

/// How well a version of the device describes the data.
struct Quality {
  double rmse = 0, held_out = 0, chi2_per_dof = 0;  ///< m, m
};

struct Diagnosis {
  std::string device;                 ///< its name
  std::string data;                   ///< where the measurements come from
  std::vector<std::string> how_read;  ///< what was converted, skipped or averaged in reading the measurements
  Verdict verdict = Verdict::nothing_missing;
  /// Recording mistakes (plausibility.h). Where the first is certain, nothing else was tested: the verdict is
  /// unknown_effect, without candidates.
  std::vector<compare::RecordingMistake> mistakes;
  /// Probability of "nothing", among the candidates of the first step, and of something unknown in addition to what was
  /// found, if anything. Where several effects were found, the candidates share the weight of these (log_weights()).
  double probability_nothing = 0, probability_unknown = 0;
  /// Of the first, the part of machines whose tolerances are larger than declared (larger_tolerances.h).
  double probability_larger_tolerances = 0;
  double larger_tolerances = 1;       ///< how large they would be, times those declared
  double chance = 1;                  ///< that some effect looks as good where nothing is missing
  int bootstrap_sets = 0;             ///< simulated data sets that `chance` is computed from
  std::vector<Candidate> candidates;  ///< of the first step, best first
  Hypothesis missing;                 ///< in the order in which they were added
  Fit fit;                            ///< of all of them
  std::vector<std::vector<std::string>> indistinguishable;
  std::vector<Tie> ties;             ///< the same with what was fitted
  std::vector<Splitting> splitting;  ///< of each of these where one was found: what to read next
  Quality baseline, final;
  measurement::Quantity quantity = measurement::Quantity::length;  ///< of errors (errors_by_group.h)
  double noise_floor = 0;                                          ///< σ of a reading, SI
  double tolerance_scale = 1;  ///< apparent size of the machine's tolerances over that declared
  std::size_t readings = 0;
  std::size_t set_aside = 0;  ///< readings that are gross outliers given what was found
  std::size_t in_play = 0;    ///< readings whose load leaves play of that open, and that may stand anywhere in it
  bool unexplained = false;
  double log_odds_unknown = 0;                           ///< ln of the odds of something unknown beside what was found
  double share_unexplained = 0;                          ///< of the misfit beyond noise and tolerances
  std::string pattern;                                   ///< the pattern of what is left
  std::string nearest;                                   ///< entry that explains most of what is left, …
  double nearest_share = 0;                              ///< … and the share of it
  std::vector<Localised> localised;                      ///< where in the subject it acts, by the laws at places
  std::vector<std::pair<std::string, double>> strained;  ///< tolerances beyond two standard deviations at the end
  std::vector<Detectable> detectable;
  std::vector<LeftOut> left_out;  ///< entries that cannot be tested on this device and these data
};

struct DiagnosisOptions {
  compare::ComparisonOptions comparison;
  int bootstrap_sets = 1999;  ///< bootstrap.h
};

/// Whether a recording mistake was found instead of a diagnosis.
bool is_mistaken(const Diagnosis&);

/// The effects must outlive the result. Only the bootstrap is divided among MPI ranks; every rank has the result.
Diagnosis diagnose(const subject::Subject&, const measurement::Measurements&, const std::vector<effects::Effect>&,
                   const DiagnosisOptions& = {}, const parallel::Work& = {});

}  // namespace deflect::diagnosis
