// Where force can be looked at inside a mechanism without a model of what is missing: statics alone.
//
// A load F at T puts the force f = gᵀF on a site; by the principle of virtual forces an elongation e there moves T by
// g e, in a determinate mechanism exactly, otherwise with the forces that the model shares out. So every reading is a
// point on a force–elongation curve of every site. Sites are the lines of legs that carry a force along a line only,
// tension positive; of other legs and of arms the driven freedoms of their joints.
#pragma once

#include <string>
#include <vector>

#include "msa/mechanism/configuration.h"

namespace deflect {

struct Site {
  std::string name;       ///< "leg 3", "shoulder rz"; the same at every pose
  bool rotation = false;  ///< f in Nm and e in rad, else N and m
  Vector6 g = Vector6::Zero();
  Vector6 s = Vector6::Zero();  ///< of a leg's line: the wrench at T of a unit force along it; 0 at joints
  double extension = 0;         ///< m: how far the site's slide is out, |L1| of a guideway; 0 without one
  double along = 1;  ///< of a leg's line: (n·a)², a the axis of its slide; across the slide it is 1 − along
};

/// The sites of a machine where it stands; none where nothing is driven.
std::vector<Site> sites_of(const Configuration&);

}  // namespace deflect
