// A plan of one reading, to be predicted. Its pose has the label "at".
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "msa/mechanism/stand.h"
#include "validation/measurement/measurements.h"
#include "validation/subject/subject.h"

namespace deflect::fit {

/// Of a machine under F_T_W (N, Nm): at the commanded pose, or at the commanded joint coordinates of the configuration.
measurement::Measurements plan_of_one(const Stand&, const Vector6& F_T_W, bool by_joints);

/// Of a frame: factors on its load cases, by name; those not named are 0. InputError with the nearest name for a case
/// that it does not have.
measurement::Measurements plan_of_one(const subject::Subject& frame,
                                      const std::vector<std::pair<std::string, double>>& factors);

}  // namespace deflect::fit
