// The shape in which equilibrium is written.
#pragma once

#include <iterator>

namespace deflect {

/// linear: in the undeformed shape; the stiffness does not depend on the forces.
/// second_order: small displacements, but internal forces rotate with the parts that carry them: their geometric
///   (stress) stiffness is added to the elastic one, K = K_E + K_G(forces).
/// finite: in the deformed shape, with rotations of any size; the stiffness is the tangent there.
enum class Geometry { linear, second_order, finite };
inline constexpr const char* geometry_names[] = {"linear", "second-order", "finite"};
static_assert(std::size(geometry_names) == 3);

}  // namespace deflect
