// Oddities of a measurement file that show in the file alone or against one prediction: rows that carry no information
// or contradict each other.
#pragma once

#include "validation/compare/comparison.h"

namespace deflect::compare {

/// Nothing measured, nothing loaded, too few readings, a column of zeros or one that stands still, identical rows.
std::vector<RecordingMistake> file_oddities(const Comparison&);

/// σ in a unit other than that of the readings.
std::vector<RecordingMistake> sigma_oddities(const Comparison&);

/// Replicates that differ by more than ten standard deviations of their difference, with their lines. Noise and errors
/// of the recorded loads count.
std::vector<RecordingMistake> contradictions(const Comparison&);

}  // namespace deflect::compare
