// What a file of measurements shows by itself, or beside one prediction: rows that say nothing, or not what they seem
// to.
#pragma once

#include "validation/compare/comparison.h"

namespace deflect::compare {

/// Nothing measured, nothing loaded, too few readings, a column of zeros, identical rows.
std::vector<RecordingMistake> file_oddities(const Comparison&);

/// σ in another unit than the readings.
std::vector<RecordingMistake> sigma_oddities(const Comparison&);

/// Replicates that differ by more than ten standard deviations of a difference, by line.
std::vector<RecordingMistake> contradictions(const Comparison&);

}  // namespace deflect::compare
