// Loads that a laboratory could put on a subject, within its limits.
//
// Of a machine: forces along ±x, ±y, ±z and moments about ±x, ±y, ±z; together forces along the diagonals of their
// octants and forces that act beside the tool point, along an axis with a moment about one or both of the others. Of a
// frame: each load case with both senses, together with others; and a force at each of the nodes of the limits, along
// each axis of the base (in the plane of a plane frame), with both senses, alone.
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
  /// N, Nm; absent: the largest of the data, of moments, where the data have none, the force · prediction::lever. Of a
  /// frame: the force at `nodes`.
  std::optional<double> force, moment;
  bool forces_only = false;
  std::size_t cases = 0;           ///< load cases of a frame at once; 0: any number
  std::vector<std::string> nodes;  ///< of a frame, or "all": where a force can be put, by a jack or a weight
  Where where = Where::workspace;  ///< or only the poses of the data
  std::optional<measurement::Measurements> poses;  ///< or those of another file
};

/// A load in full, and its words. SI.
struct PossibleLoad {
  Vector6 at_T = Vector6::Zero();
  std::vector<double> factors = {};  ///< by load case of the subject
  std::string point = {};            ///< load point of the subject; empty: none
  Vector6 at_point = Vector6::Zero();
  std::string words = {};
  bool in_full = false;  ///< only
};

/// `together`: several components, or load cases, at once too. Throws InputError where the limits leave no load, for
/// nodes that the subject does not have, and where nothing says how large a force at them may be.
std::vector<PossibleLoad> possible_loads(const subject::Subject&, const measurement::Measurements& data, const Limits&,
                                         bool together);

}  // namespace deflect::plan
