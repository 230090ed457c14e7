// A machine at a pose or at joint coordinates, as Python gives them.
#pragma once

#include <string>
#include <vector>

#include "msa/mechanism/stand.h"
#include "validation/subject/subject.h"

namespace deflect::python {

/// One of the two, or neither: at home.
struct Asked {
  std::vector<double> pose;    ///< x y z (mm), or with roll pitch yaw (deg)
  std::vector<double> joints;  ///< one for each actuator: slides in mm, turns in rad
  double slides_per_m = 1e3;   ///< 1: slides in m
};

/// InputError for a frame.
const Mechanism& machine_of(const subject::Subject&);

/// InputError for pose and joints together, for another number of coordinates and for angles that have lost their
/// digits; ModelError where the mechanism cannot assemble there.
Stand stand_of(const Mechanism&, const Asked&);

/// "linear", "second-order" or "finite".
Geometry geometry_of(const std::string&);

}  // namespace deflect::python
