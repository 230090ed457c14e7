// The reading that would best tell apart two effects that the data cannot.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/diagnosis/selection.h"

namespace deflect::diagnosis {

/// A load that goes on or comes off, and what would be read of it.
struct Splitting {
  std::vector<std::string> between;  ///< two effects of a tie, by name
  std::string reading;               ///< "uz of node M as load.snow × 1 goes on"
  measurement::Quantity quantity = measurement::Quantity::length;
  double difference = 0;  ///< between what the two predict, as fitted to the data; SI
  double deviations = 0;  ///< over the noise of two readings and the declared tolerances together
};

/// Of all readings that could be taken (subject/trials.h) the one with the largest number of deviations, for the two
/// likeliest of the tie. Nothing where the tie has no two fits, or no noise is known.
std::optional<Splitting> splitting_reading(const Observations&, const measurement::Measurements& data, const Tie&);

}  // namespace deflect::diagnosis
