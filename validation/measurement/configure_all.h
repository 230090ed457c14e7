// The mechanism at every pose that was measured.
#pragma once

#include <span>
#include <vector>

#include "msa/mechanism/configuration.h"
#include "validation/measurement/measurements.h"

namespace deflect::measurement {

/// One configuration per Measurements::poses, by inverse kinematics or, where joint coordinates were commanded, by
/// forward kinematics. Throws InputError where number or kind (rad, mm) of the joint coordinates is not the device's,
/// ModelError "file:line: column 'pose': …" for the first pose where the mechanism cannot stand. `known`: a mechanism
/// at the same poses that may have the same kinematics (configuration.h), or none.
std::vector<Configuration> configure_all(const Mechanism&, const Measurements&,
                                         std::span<const Configuration> known = {});

}  // namespace deflect::measurement
