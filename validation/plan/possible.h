// Readings that a laboratory could take of a subject: poses × loads × senses, within its limits.
//
// Of a machine: at each pose forces along ±x, ±y, ±z and moments about ±x, ±y, ±z, each in full, half and a fifth; in
// full, forces along the diagonals of their octants and forces that act beside the tool point, along an axis with a
// moment about one or both of the others. Of a frame: each load case with both senses and the same sizes, and each two
// of them together. Where some rival remembers the loads before it, a reading is a step of a sequence that begins at a
// new approach of the pose, unloaded: a load goes on; goes on and comes half off, all off, or turns to its opposite.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/measurement/measurements.h"
#include "validation/subject/subject.h"

namespace deflect::plan {

enum class Where { workspace, as_measured };

/// What the rig allows. Largest loads: of one component, absent: as in the data.
struct Limits {
  /// N, Nm; absent: the largest of the data, of moments, where the data have none, the force · prediction::lever.
  std::optional<double> force, moment;
  bool forces_only = false;
  std::size_t cases = 0;                           ///< load cases of a frame at once; 0: any number
  Where where = Where::workspace;                  ///< or only the poses of the data
  std::optional<measurement::Measurements> poses;  ///< or those of another file
};

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
/// σ. Throws InputError where the limits leave no load, ModelError where a pose of the file cannot be reached.
Possible possible_readings(const subject::Subject&, const measurement::Measurements& data, const Limits&,
                           bool sequences, std::uint64_t seed);

/// The possible ones alone, as if nothing had been taken.
Possible without_data(Possible);

/// What could be read instead of a campaign, of which nothing is taken yet: its own readings, as far as the limits
/// allow them, and all loads at its poses and others; what is read at one of its poses shares its approach.
Possible possible_campaign(const subject::Subject&, const measurement::Measurements& given, const Limits&,
                           std::uint64_t seed);

/// The blocks in the order of their poses as a file to be filled in: cells of readings are empty, a column "note" says
/// how each load is reached. Labels of poses begin with "plan".
measurement::Measurements as_plan(const Possible&, const std::vector<std::size_t>& blocks);

}  // namespace deflect::plan
