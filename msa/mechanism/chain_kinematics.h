// Kinematics of the family "chains": joint states for a pose of the platform or for actuated coordinates. They are
// reached from home along a straight path in small steps, so that the assembly mode (elbow up or down) stays that of
// home.
#pragma once

#include "msa/mechanism/closure.h"
#include "msa/mechanism/configuration.h"

namespace deflect {

struct ChainAssembly {
  std::vector<LegParts> legs;
  std::vector<std::vector<JointState>> states;  ///< by leg
  Pose pose;                                    ///< of the platform
  double length = 1;                            ///< extent of the mechanism at home, m
  std::optional<Placement> home;                ///< kinematics.home
  VectorX coordinates;                          ///< actuated ones that were asked for; none: the pose was
  std::vector<Actuator> actuators;              ///< where it was placed
};

/// Whether joints that stand somewhere in one stand there in the other too: all that kinematics read is equal. Laws,
/// sections and materials may differ.
bool same_kinematics(const std::vector<LegParts>&, const std::vector<LegParts>&);

/// Throws ModelError when the loops do not close at home, InputError when the controller matrix does not have one row
/// for each actuated coordinate.
ChainAssembly home_assembly(const Mechanism&);

/// Throws ModelError with the leg where the pose is not reached (with the distance left), where a coordinate leaves its
/// limits, or where the pose is singular (with the direction in which the leg's end can no longer move).
void move_to(ChainAssembly&, const Pose&);

/// The same for actuated coordinates in the order of the walk; a singular pose is no error.
void move_to_coordinates(ChainAssembly&, const VectorX& actuated);

/// Values and names of the actuated coordinates, in the order of the walk.
struct ActuatedCoordinates {
  VectorX values;
  std::vector<std::string> names;
  std::vector<bool> rotation;
};
ActuatedCoordinates actuated(const ChainAssembly&);

/// The same with the joints at home; the loops need not close there.
ActuatedCoordinates actuated_at_home(const Mechanism&);

}  // namespace deflect
