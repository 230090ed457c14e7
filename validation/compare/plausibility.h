// Data that are not what they say: mistakes of recording, which no physics explains.
//
// A mistake is looked for where the readings do not fit. Corrections (recording_mistakes.h) are tried on the prediction
// of some readings; those that take a good part of the misfit away are tried on all of them, by a comparison of the
// corrected data. One is told when the corrected data need clearly less to explain them than the recorded ones with the
// patterns that physics can leave (findings.h), and the misfit beyond noise and tolerances falls to less than a ninth
// in χ² where they are then right to the noise, to a 36th where something else is left; or, where it is more than a
// quarter of what was measured, to a sixth. Where it is that large and a change of units or axes makes it right to the
// noise, that is told before any physics. Fitted corrections, a shift of the poses or of the point of the load, must
// make it right to the noise.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "validation/measurement/measurements.h"
#include "validation/parallel/cases.h"

namespace deflect::subject {
class Subject;
}

namespace deflect::compare {

struct Comparison;

/// Something about a file that comes before what it says of the machine.
struct RecordingMistake {
  /// Of the corrections that do equally well, best first; or "nothing_measured", "nothing_loaded", "zero_column",
  /// "identical_rows", "sigma_unit", "too_few", "contradiction".
  std::vector<std::string> ids;
  std::string sentence;  ///< what the data look like, with the remedy
  bool certain = true;   ///< a verdict on the machine has no ground; false: a remark
};

/// What is left of a misfit, and what it took to leave no more.
struct MisfitAccount {
  double numbers = 0, chi2 = 0;  ///< without the readings set aside
  double left = 0;               ///< χ² with the findings; 0: not known yet
  int columns = 0;               ///< of the findings
  std::size_t set_aside = 0;     ///< readings
  double share = 0;              ///< misfit of all readings by what was measured, root mean squares
  double scatter = 0;            ///< σ by what was measured, where it is estimated from residuals; 0 where given
};
MisfitAccount account_of(const Comparison&);

/// Whether data of which no more speaks against them than in the account may be right; asked on the way.
using CanBeRight = std::function<bool(const MisfitAccount&)>;
/// Compares other data with the same device; empty where they cannot be right.
using ComparedAgain = std::function<std::optional<MisfitAccount>(const measurement::Measurements&, const CanBeRight&)>;

/// The first is the headline where it is certain.
std::vector<RecordingMistake> recording_mistakes(const subject::Subject&, const Comparison&, int threads,
                                                 const ComparedAgain&);

/// What to add to the message about a pose that cannot be reached: which corrections of the poses bring all of them
/// within reach; empty where none does.
std::string within_reach_hint(const subject::Subject&, const measurement::Measurements&);

}  // namespace deflect::compare
