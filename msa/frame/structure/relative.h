// Relative coordinates for very stiff parts. A member 1e12 times stiffer than its neighbours moves almost as a rigid
// body: its forces are differences of displacements that agree to twelve digits, and lose all accuracy. Such a part
// gets its deformation as coordinates, u_b = X u_a + s, so that its stiffness acts on s and its rigid motion causes
// exactly no force. The structure is the same, and accuracy does not depend on the ratio of stiffnesses.
#pragma once

#include "msa/frame/structure/model.h"

namespace deflect::frame {

/// Ten times the stiffest part, N/m.
double contact_stiffness(const Model&);

/// Sets the contact stiffness of gaps and rigid sides of springs (stepped_spring.h) to ten times the stiffest part, so
/// that each update of λ reduces its error to a tenth at most.
void give_contacts_stiffness(Model&);

/// Whether the next function would find a beam or a spring to change.
bool wants_relative_motion(const Model&, double ratio = 1e5);

/// Gives relative coordinates to springs that jump, to beams whose bending stiffness EI/L exceeds `ratio` times that of
/// the softest beam or spring that others hang on, and to linear springs whose stiffness times the squared length of
/// the structure exceeds 1e4 times that limit (a translational spring; a rotational one counts alike). A part beside
/// stiffer ones, a member that is all but missing, moves little, and others lose no digits by it: it counts as 1e4
/// times as stiff as it is. Returns the names of those parts.
std::vector<std::string> use_relative_motion(Model&, double ratio = 1e5);

}  // namespace deflect::frame
