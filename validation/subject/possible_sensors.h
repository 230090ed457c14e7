// Instruments that a subject does not have and could be given: where else it could be read.
//
//   machine  displacement of the tool point along and about each axis of W; inside the legs, displacement along each
//            axis of W of the body behind each joint and member, where that part ends
//   frame    displacement of each node along and about each axis of W that its plane has; axial force of each member
#pragma once

#include <string>
#include <vector>

#include "validation/subject/subject.h"

namespace deflect::subject {

struct PossibleSensor {
  std::string name;   ///< "uz of node B"; of a machine "uz_of_upper_arm_in_leg_2"
  std::string entry;  ///< in the description, without σ: "node: B, direction: uz"
  measurement::Quantity quantity = measurement::Quantity::length;
  /// SI; the least of the subject's own sensors of that quantity, of rotations, where it has none, that of
  /// displacements over a tenth of its size; 0: not known.
  double sigma = 0;
};

/// Those that no sensor of the subject reads already. Of the tool point all six are there: which of them are read says
/// the file of the data.
std::vector<PossibleSensor> possible_sensors(const Subject&);
/// Of the one at the tool point of a machine: component 0 … 5 of [δ; θ].
std::string name_at_tool_point(std::size_t component);

/// A copy that has some of them too, named so, with the σ that stands in them.
Subject with_sensors(const Subject&, const std::vector<PossibleSensor>&);

}  // namespace deflect::subject
