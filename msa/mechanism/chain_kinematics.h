// Kinematics of the family "chains": joint states for a pose of the platform or for actuated coordinates. They are
// reached from home along a straight path in small steps, so that the assembly mode (elbow up or down) stays that of
// home.
#pragma once

#include "msa/mechanism/closure.h"

namespace deflect {

struct Assembly {
  std::vector<LegParts> legs;
  std::vector<std::vector<JointState>> states;  ///< by leg
  Pose pose;                                    ///< of the platform
  double length = 1;                            ///< extent of the mechanism at home, m
};

/// Throws ModelError when the loops do not close at home, InputError when the controller matrix does not have one row
/// for each actuated coordinate.
Assembly home_assembly(const Mechanism&);

/// Throws ModelError with the leg where the pose is not reached (with the distance left), where a coordinate leaves its
/// limits, or where the pose is singular (with the direction in which the leg's end can no longer move).
void move_to(Assembly&, const Pose&);

/// The same for actuated coordinates in the order of the walk; a singular pose is no error.
void move_to_coordinates(Assembly&, const VectorX& actuated);

/// Values and names of the actuated coordinates, in the order of the walk.
struct ActuatedCoordinates {
  VectorX values;
  std::vector<std::string> names;
  std::vector<bool> rotation;
};
ActuatedCoordinates actuated(const Assembly&);

/// The same with the joints at home; the loops need not close there.
ActuatedCoordinates actuated_at_home(const Mechanism&);

}  // namespace deflect
