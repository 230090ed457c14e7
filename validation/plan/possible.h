// Readings that a laboratory could take of a subject: poses × loads × senses, within its limits.
//
// Loads are those of possible_loads.h, at each pose of a machine, in full, those of one component or load case also
// half and a fifth. Where some rival remembers the loads before it, a reading is a step of a sequence that begins at a
// new approach of the pose, unloaded: a load goes on; goes on and comes half off, all off, or turns to its opposite.
#pragma once

#include <vector>

#include "validation/plan/possible_loads.h"

namespace deflect::plan {

/// Readings that are taken together, in a row.
struct Block {
  std::size_t first = 0, count = 1;
  std::size_t pose = 0;  ///< index into the measurements' poses
};

struct Possible {
  measurement::Measurements all;        ///< those that were taken, then those that could be
  std::size_t taken = 0;                ///< number of the former
  std::vector<Block> blocks;            ///< of the latter
  std::vector<std::size_t> given = {};  ///< blocks of these that are the readings of a campaign given
  bool sequences = false;               ///< each block begins at an approach of its own

  /// The readings taken, alone.
  measurement::Measurements data() const;
};

/// `seed`: of poses that are drawn in the workspace. All components and sensors that the data have are read, with their
/// σ. Throws what possible_loads() throws, ModelError where a pose of the file cannot be reached.
Possible possible_readings(const subject::Subject&, const measurement::Measurements& data, const Limits&,
                           bool sequences, std::uint64_t seed);

/// The possible ones alone, as if nothing had been taken.
Possible without_data(Possible);

/// What could be read instead of a campaign, of which nothing is taken yet: its own readings, as far as the limits
/// allow them, and all loads at its poses and others; what is read at one of its poses shares its approach.
Possible possible_campaign(const subject::Subject&, const measurement::Measurements& given, const Limits&,
                           std::uint64_t seed);

/// The same blocks, those of one pose one after the other: a pose is approached once. Poses come in the order in which
/// they were chosen first.
std::vector<std::size_t> pose_by_pose(const Possible&, std::vector<std::size_t> blocks);

/// The blocks pose_by_pose() as a file to be filled in: cells of readings are empty, a column "note" says how each load
/// is reached. Labels of poses begin with "plan".
measurement::Measurements as_plan(const Possible&, const std::vector<std::size_t>& blocks);

}  // namespace deflect::plan
