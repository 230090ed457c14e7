// Exactness beside very stiff parts. A member 1e12 times stiffer than its neighbours moves almost as a rigid body: its
// forces are differences of displacements that agree to twelve digits, and nothing of them is left. Such a part gets
// the deformation itself as coordinates, u_b = X u_a + s, so that its stiffness acts on s and its rigid motion costs
// exactly nothing. The structure is the same; any ratio of stiffnesses, up to rigid, has the same digits.
#pragma once

#include "msa/frame/model.h"

namespace deflect::frame {

/// Gives relative coordinates to beams whose bending stiffness EI/L exceeds `ratio` times the softest beam's, and to
/// linear springs whose stiffness times the squared length of the structure exceeds 1e4 times that limit (a
/// translational spring; a rotational one counts alike). Returns the names of those parts.
std::vector<std::string> use_relative_motion(Model&, double ratio = 1e5);

}  // namespace deflect::frame
