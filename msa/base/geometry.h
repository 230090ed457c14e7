// In which shape equilibrium is written down.
#pragma once

#include <iterator>

namespace deflect {

/// linear: in the undeformed shape; stiffness does not know the forces.
/// second_order: displacements small, but the forces of the state turn with the parts that carry them: their geometric
///   (stress) stiffness is added to the elastic one, K = K_E + K_G(forces).
/// finite: in the deformed shape, rotations of any size; stiffness is the tangent there.
enum class Geometry { linear, second_order, finite };
inline constexpr const char* geometry_names[] = {"linear", "second-order", "finite"};
static_assert(std::size(geometry_names) == 3);

}  // namespace deflect
