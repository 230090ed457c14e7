// Mobility of a structure: the motions that no member, spring or support resists. This depends on kinematics only;
// sizes, units and ratios of stiffness do not matter.
//
// Rigid pieces (pieces.h) move by coordinates y. A motion is free where B y = 0 for all conditions, that is constraints
// and springs that resist. Coordinates that occur in no condition are free. For the others σ = |B y|/|y| decides: a
// motion with σ < 1e-10, the rounding of positions, counts as free. Block inverse iteration on BᵀB finds the small σ;
// the singular values of B on that block give them without squaring.
//
// A free motion is idle where it does not move the model's watched node or, if there is none, displaces no node
// (members spin, hinged nodes rotate). Idle motions are harmless as long as no load acts on them.
#pragma once

#include <vector>

#include "msa/frame/structure/model.h"

namespace deflect::frame {

struct IdleMotion {
  LinearForm u;     ///< the motion by freedom, m and rad; 0 for freedoms not listed
  LinearForm hold;  ///< a constraint that holds it: hold(u) = 1, and 0 of all other idle motions
};

struct Mobility {
  std::vector<IdleMotion> idle;
  MatrixX free;              ///< the other free motions, columns by freedom; empty: the structure can stand
  double largest_free = 0;   ///< σ
  double smallest_held = 1;  ///< smallest σ that counts as held; near 0 the structure is nearly a mechanism
  VectorX softest;           ///< the motion of smallest_held by freedom, where smallest_held < 1e-5
};

/// `resists`: by spring, whether it counts as a condition.
Mobility mobility_of(const Model&, const std::vector<char>& resists);

/// A cheap subset: the idle motions of single pieces that occur in no condition (hinged nodes and members).
std::vector<IdleMotion> loose_pieces(const Model&, const std::vector<char>& resists);

}  // namespace deflect::frame
