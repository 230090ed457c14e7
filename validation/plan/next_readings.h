// What to measure next: the readings that best tell the effects of a tie apart.
//
// Candidates are possible_readings(); they are chosen for the aim of rivals.h, robust over the rivals' parameters, with
// all tolerances as nuisances: readings at one pose share its errors, and those that were taken count.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "validation/plan/new_sensors.h"

namespace deflect::plan {

struct PlanOptions {
  Limits limits;
  Noise noise;
  std::size_t readings = 30;   ///< at most
  double probability = 0.95;   ///< of the true effect, expected, at which the plan is long enough
  std::size_t most_poses = 0;  ///< 0: any number
  int draws = 6;               ///< of each rival's parameters
  std::uint64_t seed = 1;
};

/// After so many readings.
struct Step {
  std::size_t readings = 0;
  double probability = 0;   ///< expected of the true effect
  std::vector<Pair> pairs;  ///< expected separations by them
};

/// Two rivals that no reading within the limits tells apart.
struct Inseparable {
  Pair pair;                         ///< with every reading there is
  std::vector<std::string> instead;  ///< what would: sentences
};

struct Plan {
  std::string subject, data;
  std::vector<Rival> rivals;
  std::size_t taken = 0, possible = 0;  ///< readings
  measurement::Measurements readings;   ///< as_plan(); empty where no pair can be told apart
  std::array<bool, 6> read = {};        ///< components of the displacement that are to be filled in
  std::vector<Step> steps;              ///< from none on
  std::vector<Pair> as_planned;         ///< of the plan as it stands, in its sequence
  double probability = 0;               ///< the same
  std::size_t at_random = 0;       ///< readings drawn from the same poses and loads for the same probability, median
  bool at_random_is_more = false;  ///< than that number, where the search ended
  std::vector<Inseparable> inseparable;
  /// What would help more than readings: instruments that the subject does not have, in the readings planned, or, where
  /// none is, in those of the data taken again.
  std::vector<NewSensor> sensors;
};

/// Throws as possible_readings(), Prospect and Rivalry do. The result does not depend on the number of threads.
Plan next_readings(const subject::Subject&, const measurement::Measurements& data, std::vector<Rival>,
                   const PlanOptions&, const parallel::Work& = {});

/// What readings in their sequence add to the data, whose tie has these rivals.
Step expected_of(const subject::Subject&, const measurement::Measurements& data, const measurement::Measurements& added,
                 const std::vector<Rival>&, const PlanOptions&, const parallel::Work& = {});

}  // namespace deflect::plan
