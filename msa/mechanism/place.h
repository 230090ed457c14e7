// Places parts of the description where the kinematics put them, and resolves their names.
#pragma once

#include "msa/mechanism/configuration.h"

namespace deflect {

/// Place and axes of a joint, and the extension of its leg's actuator (for cables), m.
struct JointPlace {
  Vector3 p_W;
  Matrix3 R_WJ;
  double actuator = 0;
};

/// Throws InputError where a name does not resolve.
PlacedJoint placed(const Joint&, const std::string& part, const JointPlace&, const Mechanism&);

/// Appends the joint to a leg of that name. Where it has `beside` laws, it becomes a PlacedParallel with these laws as
/// branches.
void put(PlacedJoint, const std::array<std::vector<Law>, 6>& beside, const std::string& leg, std::vector<PlacedPart>&);

/// Joint::beside with materials resolved.
std::array<std::vector<Law>, 6> beside_of(const Joint&, const Mechanism&, double actuator);

/// Appends the member, with a joint at each end that yields.
void put(const Member&, PlacedMember, const Mechanism&, std::vector<PlacedPart>&);

/// From start to end. Local y lies in the plane of the member and `reference`, or `otherwise` where the reference is
/// (within 2.6 deg) along the member. Throws ModelError where the length is 0.
PlacedMember placed(const Member&, const std::string& part, const Vector3& p_W_start, const Vector3& p_W_end,
                    const Vector3& reference, const Vector3& otherwise, const Mechanism&);

/// The same for a member of which only the place is not known.
void place_between(PlacedMember&, const Vector3& p_W_start, const Vector3& p_W_end, const Vector3& reference,
                   const Vector3& otherwise);

/// The freedoms of a joint, from its own letters or its type's row.
std::array<Freedom, 6> freedoms_of(const Joint&);

/// Right-handed axes with the given z, x in the plane of z and `reference`, or `otherwise` where the reference lies
/// along z.
Matrix3 axes_along_z(const Vector3& z, const Vector3& reference, const Vector3& otherwise = Vector3::UnitZ());

}  // namespace deflect
