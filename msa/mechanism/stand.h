// Poses in the user's units, and a mechanism at such a pose.
#pragma once

#include "msa/base/geometry.h"
#include "msa/base/spatial.h"
#include "msa/mechanism/configuration.h"

namespace deflect {

/// x y z roll pitch yaw in mm and deg, R = Rz(yaw) Ry(pitch) Rx(roll), and back.
Pose pose_from(const Vector6& mm_deg);
Vector6 mm_deg_from(const Pose&);

/// A mechanism's configuration, and its pose in the user's units: x y z roll pitch yaw in mm and deg.
struct Stand {
  Vector6 pose_mm_deg;
  Configuration configuration;
};
Stand stand(const Mechanism&, const Vector6& pose_mm_deg);

}  // namespace deflect
