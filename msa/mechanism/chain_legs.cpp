#include "msa/base/error.h"
#include "msa/mechanism/family.h"
namespace deflect {
PlacedMechanism place(const Chains&, const Mechanism&, const Pose&) { throw ModelError("to come"); }
PlacedMechanism place_joints(const Chains&, const Mechanism&, const VectorX&) { throw ModelError("to come"); }
Pose home_pose(const Chains&, const Mechanism&) { return {}; }
std::vector<Actuator> actuators_of(const Chains&, const Mechanism&) { return {}; }
}  // namespace deflect
