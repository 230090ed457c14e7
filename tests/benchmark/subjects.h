// How well each machine and each frame is diagnosed: the same questions to all of them, entries and laws at places
// hidden alike.
//
// Beside the built-in ones stand the actuator of validation/measurements/cycloid, read as its records are, and two arms
// by the dice (random_arm.h).
//
// A set is measured on a subject within its tolerances. Of a machine: by the MSA in the deformed shape, σ of a reading
// a fiftieth of the rms displacement; the diagnosis uses the closed form. Of a frame, for which there is no other
// theory: by the MSA with 'geometry: finite' (corotational elements), the effect in it, with the σ of its own sensors;
// the diagnosis uses linear geometry and what the deformed shape adds. Sets from a program that shares nothing with
// deflect are made by tests/verification/foreign_frames.py.
//
// Twelve sets take turns, with every other subject from the seventh on, so that a few of each are of all kinds:
//   healthy    nothing is hidden (1)
//   stress     nothing, but doubled tolerances, t(3) noise or 2 % gross outliers (1)
//   one        an entry or a law at a place, by turns and drawn by lot, at λ = 4, 8 and 16 (6)
//   pair       two of them, at λ = 8 and 16 each (2)
//   left out   a law at a place, λ_res = 18, which is taken out of the candidates: is the place found by what acts
//              near it? (1)
//   unknown    one of them, λ_res = 9, all that the data cannot tell from it taken out (1)
//
// Effects that the data cannot tell from the hidden one (2 Δ ln L < 9) are its class (class_judge.h). λ_res of what is
// not among the candidates: what is left of its change once the four of them that take most of it off, one after the
// other, are taken out of it; four are as many as a diagnosis names. A law of which the others leave less than a
// twentieth of λ is not drawn: no answer could tell that it is unknown.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/benchmark/class_judge.h"
#include "validation/parallel/journal.h"

namespace deflect::benchmark {

enum class SetKind { healthy, stress, one, pair, left_out, unknown };
inline constexpr const char* set_kind_names[] = {"healthy", "stress", "one", "pair", "left out", "unknown"};

/// What is hidden is not among the candidates.
inline bool is_open(SetKind kind) { return kind == SetKind::left_out || kind == SetKind::unknown; }

struct SubjectSet {
  SetKind kind = SetKind::healthy;
  std::string skipped;                ///< why there is no such set; empty where there is one
  std::vector<std::string> hidden;    ///< "clearance@elbow.rz (leg 2)"
  std::vector<EffectClass> classes;   ///< of each
  double lambda = 0, lambda_res = 0;  ///< of each hidden effect; of what is not among the candidates
  Answer answer;
  double seconds = 0;  ///< of the diagnosis
  int stress = -1;     ///< by index in stress_names; −1: none
  /// Answers by an exact Bayes oracle (oracle.h), of one effect or none, or of a pair.
  bool oracle_asked = false, oracle_right = false;
  std::size_t oracle_reported = 0;
  /// 95 % intervals of effects that are found where they are, and those that hold the truth; (found − true)/σ of the
  /// first value.
  int intervals = 0, covering = 0;
  std::optional<double> bias;
  /// Where something is not among the candidates: effects named and laws at the places told, and how many of them act
  /// at the hidden one's place or are of its class.
  std::vector<std::string> told;
  int told_rightly = 0;
  /// Of a machine with one hidden effect: rms error of the prediction at new poses over σ of a reading.
  std::optional<double> new_poses;
};

struct SubjectRow {
  std::string name;
  bool frame = false;
  std::size_t candidates = 0;  ///< that act
  std::vector<SubjectSet> sets;
};

/// Of the machines and frames of those names ("all": every machine and the frames with sensors), so many sets each, or
/// so many of one kind; in parallel, the same for any number of threads. `done` is called with what there is after each
/// subject. InputError on an unknown name. `journal`: sets that it holds are taken from it, the others kept there.
std::vector<SubjectRow> diagnose_subjects(const std::vector<std::string>& names, std::size_t sets,
                                          std::optional<SetKind> kind, std::uint64_t seed, int threads,
                                          const std::function<void(const std::vector<SubjectRow>&)>& done = {},
                                          parallel::Journal* journal = nullptr);

}  // namespace deflect::benchmark
