// Parts of the description with their names resolved, standing where the kinematics put them.
#pragma once

#include "msa/mechanism/configuration.h"

namespace deflect {

/// Where a joint stands and the extension of the actuator of its leg (for cables), m.
struct JointPlace {
  Vector3 p_W;
  Matrix3 R_WJ;
  double actuator = 0;
};

/// Throws InputError on names that do not resolve.
PlacedJoint placed(const Joint&, const std::string& part, const JointPlace&, const Mechanism&);

/// Adds the joint to a leg of that name, in the place where it stands; with `beside` laws on its freedoms as branches.
void put(PlacedJoint, const std::array<std::vector<Law>, 6>& beside, const std::string& leg, std::vector<PlacedPart>&);

/// Laws with their materials resolved.
std::array<std::vector<Law>, 6> beside_of(const Joint&, const Mechanism&, double actuator);

/// Adds the member, between joints where its ends yield.
void put(const Member&, PlacedMember, const Mechanism&, std::vector<PlacedPart>&);

/// From start to end, local y in the plane of the member and `reference`, or of `otherwise` where the reference lies
/// along the member. Throws ModelError when it has no length.
PlacedMember placed(const Member&, const std::string& part, const Vector3& p_W_start, const Vector3& p_W_end,
                    const Vector3& reference, const Vector3& otherwise, const Mechanism&);

/// The same for a member that is known but for its place.
void place_between(PlacedMember&, const Vector3& p_W_start, const Vector3& p_W_end, const Vector3& reference,
                   const Vector3& otherwise);

/// The freedoms of a joint: of its type's row, or its own letters.
std::array<Freedom, 6> freedoms_of(const Joint&);

/// Right-handed axes with the given z, x in the plane of z and `reference`, or of `otherwise` where the reference lies
/// along z.
Matrix3 axes_along_z(const Vector3& z, const Vector3& reference, const Vector3& otherwise = Vector3::UnitZ());

}  // namespace deflect
