// Readings that could be taken of a subject, to ask what they would tell.
#pragma once

#include "validation/measurement/measurements.h"
#include "validation/subject/subject.h"

namespace deflect::subject {

/// A frame with a sensor for each motion of every node that none of its own reads (possible_sensors.h). None where no
/// sensor reads a displacement. A machine is read at its tool point: it comes back as it is.
Subject instrumented(const Subject&);

/// What a machine was loaded by: the largest component of a force, N, and of a moment, Nm, at T. Where the readings
/// have only one of the two, the other has an arm of a tenth of the machine's size.
struct LargestLoads {
  double force = 0, moment = 0;
};
LargestLoads largest_loads(const Subject&, const measurement::Measurements&);

/// Of a frame: the largest factor on each of its load cases in the data; 1 where they do not have it.
std::vector<double> largest_factors(const Subject&, const measurement::Measurements&);

/// Forces that can stand at nodes of a frame, one at a time.
struct ForcesAtNodes {
  std::vector<std::string> points;  ///< load points: "node.B"
  std::vector<Eigen::Index> axes;   ///< of the base: all, or those of a plane frame's plane
  /// N: the largest component of a force at one node in a row of the data, or in a load case times the largest factor
  /// on it in the data (1 where they do not have it).
  double most = 0;
};
/// `nodes`: their names, or "all"; without any the nodes that the data load. Throws InputError for a name that is none.
ForcesAtNodes forces_at_nodes(const Subject&, const measurement::Measurements&, const std::vector<std::string>& nodes);

/// Each load alone goes on, comes off, goes on the other way and comes off, in sequence, from an unloaded reading on:
/// of a frame the load cases, of a machine forces and moments at T along x, y and z at the poses of the data (nine at
/// most); as large as they are in the data. The note of each row names its load, "load.snow × 1", "fz = -50 N at pose
/// 3". All sensors are read, of a machine the displacement of T.
inline constexpr int rows_of_a_load = 5;
measurement::Measurements trial_readings(const Subject&, const measurement::Measurements& data);

}  // namespace deflect::subject
