// Which physical effect is missing: every effect of a catalogue, at every place it has in the device, is fitted to the
// residual with all tolerances free under their priors; the evidence decides, and says when it cannot.
//
// Detection: the best effect must beat what the best of all effects reaches by chance in data with nothing missing.
// Selection: prior · evidence (evidence.h), effects that do the same to these data sharing one prior. Further effects
// are added as long as they are called for (selection.h). What is left is tested against a structured discrepancy made
// of all patterns of `compare`; where that wins, something is unknown, and only effects that are called for beside the
// discrepancy are still said to be missing. Before all of it stand the mistakes of recording (plausibility.h): where
// one is certain, and the file is not to be taken as it is recorded (ComparisonOptions), no effect is looked for.
#pragma once

#include <string>
#include <vector>

#include "validation/diagnosis/candidates.h"
#include "validation/diagnosis/detectable.h"
#include "validation/diagnosis/localised.h"
#include "validation/parallel/ranks.h"

namespace deflect::diagnosis {

enum class Verdict { nothing_missing, effect, ambiguous, unknown_effect };
inline constexpr const char* verdict_names[] = {"nothing_missing", "effect", "ambiguous", "unknown_effect"};

/// How well a state of the device describes the data.
struct Quality {
  double rmse = 0, held_out = 0, chi2_per_dof = 0;  ///< m, m
};

struct Diagnosis {
  std::string device;                 ///< its name
  std::vector<std::string> how_read;  ///< of the measurements: what was converted, skipped or averaged
  Verdict verdict = Verdict::nothing_missing;
  /// Of recording (plausibility.h). Where the first is certain nothing else was asked: something unknown is said to be
  /// missing, without candidates.
  std::vector<compare::RecordingMistake> mistakes;
  /// Of "nothing" beside the candidates of the first step, and of something unknown: beside what was found, if any.
  double probability_nothing = 0, probability_unknown = 0;
  double chance = 1;                  ///< of any effect looking as good with nothing missing
  int bootstrap_sets = 0;             ///< drawn to find it
  std::vector<Candidate> candidates;  ///< of the first step, best first
  Hypothesis missing;                 ///< in the order in which they were added
  Fit fit;                            ///< of all of them
  std::vector<std::vector<std::string>> indistinguishable;
  Quality baseline, final;
  bool rotations = false;      ///< none but rotations were measured: rad where m is said
  double noise_floor = 0;      ///< m: σ of a reading
  double tolerance_scale = 1;  ///< how many times the declared tolerances those of the machine look
  std::size_t readings = 0;
  std::size_t set_aside = 0;  ///< readings that are gross outliers to what was found
  bool unexplained = false;
  double share_unexplained = 0;                          ///< of the misfit beyond noise and tolerances
  std::string pattern;                                   ///< of what is left
  std::string nearest;                                   ///< entry that comes nearest to what is left, …
  double nearest_share = 0;                              ///< … and how much of that it would take off
  std::vector<Localised> localised;                      ///< where it acts, by the laws at places
  std::vector<std::pair<std::string, double>> strained;  ///< tolerances beyond two deviations at the end
  std::vector<Detectable> detectable;
  std::vector<LeftOut> left_out;  ///< entries that are no hypothesis for this device and these data
};

struct DiagnosisOptions {
  compare::ComparisonOptions comparison;
  int bootstrap_sets = 1999;  ///< bootstrap.h
};

/// Whether a mistake of recording took the place of a diagnosis.
bool is_mistaken(const Diagnosis&);

/// The effects must outlive the result. Ranks share the bootstrap alone; all have the result.
Diagnosis diagnose(const subject::Subject&, const measurement::Measurements&, const std::vector<effects::Effect>&,
                   const DiagnosisOptions& = {}, const parallel::Work& = {});

}  // namespace deflect::diagnosis
