// What every family of mechanisms provides: one overload each, listed in the variant Kinematics.
#pragma once

#include "msa/mechanism/configuration.h"

namespace deflect {

/// Where a leg stands on the base and on the platform.
struct Seats {
  Vector3 p_W_base, p_W_platform;
};

struct PlacedMechanism {
  Pose pose;
  std::vector<PlacedLeg> legs;
  std::vector<Seats> seats;  ///< of the legs
  std::vector<Actuator> actuators;
};

/// At a pose, from joint coordinates, at home: as configure(), configure_joints(), home_pose() say.
PlacedMechanism place(const SixPsu&, const Mechanism&, const Pose&);
PlacedMechanism place_joints(const SixPsu&, const Mechanism&, const VectorX& coordinates);
Pose home_pose(const SixPsu&, const Mechanism&);
std::vector<Actuator> actuators_of(const SixPsu&, const Mechanism&);

PlacedMechanism place(const Chains&, const Mechanism&, const Pose&);
PlacedMechanism place_joints(const Chains&, const Mechanism&, const VectorX& coordinates);
Pose home_pose(const Chains&, const Mechanism&);
std::vector<Actuator> actuators_of(const Chains&, const Mechanism&);

}  // namespace deflect
