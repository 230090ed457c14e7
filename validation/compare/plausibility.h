// Recording mistakes: data that are not what the file states, in a way that no physics explains.
//
// Mistakes are searched for only where the readings fit badly. Corrections (recording_mistakes.h) are first tried on
// the prediction of some readings. Those that remove a good part of the misfit are tried on all readings, by a
// comparison of the corrected data. Below, "leaves only noise" means that the corrected data fit to noise and
// tolerances, and the excess is χ² beyond noise and tolerances. A correction of units or axes is reported
//   - where the corrected data need clearly less to explain them than the recorded data with the patterns that physics
//     can leave (findings.h), and the excess falls below 1/9 of its size where the correction leaves only noise, below
//     1/36 where it leaves more; or, for a misfit of more than a quarter of what was measured, the misfit falls below
//     1/6 of its size;
//   - where the misfit is more than a quarter of what was measured and the correction leaves only noise: this comes
//     before any physics;
//   - where the correction leaves only noise and less than 1/20 of the misfit.
// Where sensors' channels are corrected, the misfit that counts is theirs, over what they measured: of a force that is
// recorded with the other sign the errors of displacements say nothing.
// A fitted correction (a shift of the poses or of the point of the load) is reported only where it leaves only noise
// or, nearly as good, less than 1/20 of the misfit. A sensor is in another unit only where its readings, so corrected,
// follow the prediction beyond chance (ChannelScreen::follows): else it may as well read something of another sensor.
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

/// A mistake in a file, to be settled before the file says anything about the machine.
struct RecordingMistake {
  /// Ids of the corrections that do equally well, best first; or "nothing_measured", "nothing_loaded", "zero_column",
  /// "identical_rows", "sigma_unit", "too_few", "contradiction".
  std::vector<std::string> ids;
  std::string sentence;  ///< what the data look like, and the remedy
  bool certain = true;   ///< true: the data support no verdict on the machine; false: only a remark
};

/// The misfit that is left, and what was fitted or set aside to reach it.
struct MisfitAccount {
  double numbers = 0, chi2 = 0;               ///< of the readings not set aside
  double left = 0;                            ///< χ² after the findings; 0: not known yet
  int columns = 0;                            ///< of the findings
  std::size_t set_aside = 0;                  ///< readings
  double share = 0;                           ///< misfit of all readings over what was measured, as root mean squares
  bool estimated = false;                     ///< σ of the numbers that Errors speak of, from residuals
  std::vector<double> share_of_channel = {};  ///< the same of each channel; 0 where it was not measured
  double density = 0;  ///< Σ 2 ln of σ over what the channel measured (rms), of the numbers whose σ is estimated
};
MisfitAccount account_of(const Comparison&);
/// MisfitAccount::share_of_channel.
std::vector<double> shares_by_channel(const Comparison&);

/// Whether data may still be right, judged by a preliminary account; called during a comparison.
using CanBeRight = std::function<bool(const MisfitAccount&)>;
/// Compares other data with the same device; nullopt as soon as they cannot be right.
using ComparedAgain = std::function<std::optional<MisfitAccount>(const measurement::Measurements&, const CanBeRight&)>;

/// The mistakes found; the first is the headline where it is certain.
std::vector<RecordingMistake> recording_mistakes(const subject::Subject&, const Comparison&, int threads,
                                                 const ComparedAgain&);

/// A hint to append to the message about a machine that does not stand: that it does as drawn, without tolerances; else
/// the corrections of the poses that make all of them reachable; empty where there is none.
std::string within_reach_hint(const subject::Subject&, const measurement::Measurements&);

}  // namespace deflect::compare
