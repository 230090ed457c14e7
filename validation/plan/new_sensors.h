// A further instrument for a tie: one that the subject does not have, read beside the others in the planned readings.
#pragma once

#include <string>
#include <vector>

#include "validation/plan/rivals.h"
#include "validation/subject/possible_sensors.h"

namespace deflect::plan {

struct NewSensor {
  subject::PossibleSensor sensor;   ///< with the σ that was taken for it
  double probability = 0;           ///< of the true effect, expected, when it is read in all of the readings
  std::vector<std::size_t> enough;  ///< of them for the probability wanted, by number from 0; empty: not even all
  double separation = 0;            ///< λ² of the nearest two rivals by all of them
};

struct SensorOptions {
  Noise noise;
  double probability = 0.95;  ///< wanted
  int draws = 6;              ///< of each rival's parameters
  std::uint64_t seed = 1;
  bool in_order = false;  ///< the readings are sequences, which keep their order; else those that tell most come first
};

/// The most useful ones among subject::possible_sensors(), best first, at most three. All are compared by what the
/// rivals, as fitted, make them read differently, over σ; of those that differ most, each in its own way, the ones that
/// promise most to first order are judged as readings are (rivals.h). σ, where nothing tells it: that of displacements
/// in the data, of rotations theirs, or that of displacements over a tenth of the subject's size. One of unknown σ is
/// left out, and so is one that tells nothing (λ² below nothing_tells). `added`: with the cells filled that the data
/// have.
std::vector<NewSensor> new_sensors(const subject::Subject&, const measurement::Measurements& data,
                                   const measurement::Measurements& added, const std::vector<Rival>&,
                                   const SensorOptions&, const parallel::Work& = {});

}  // namespace deflect::plan
