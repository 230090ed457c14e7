// Whether a structure can stand: the motions that no member, spring or support resists. A question of kinematics alone;
// sizes, units and ratios of stiffness do not matter.
//
// Rigid pieces (pieces.h) move by coordinates y. A motion is free where B y = 0 for all conditions, constraints and
// springs that resist. What no condition sees is free at once. Of the rest σ = |B y|/|y| decides: a motion with
// σ < 1e-10, the rounding of positions, counts as free. Block inverse iteration on BᵀB finds the small σ; the singular
// values of B on that block measure them without squaring.
//
// A free motion is idle where nothing that is read moves: the watched node of the model, or, where it has none, no node
// is displaced (members spin, hinged nodes turn). Idle motions do no harm as long as no load drives them.
#pragma once

#include <vector>

#include "msa/frame/structure/model.h"

namespace deflect::frame {

struct IdleMotion {
  LinearForm u;     ///< the motion by freedom, m and rad; it rests where it is not named
  LinearForm hold;  ///< a constraint that holds it: hold(u) = 1, and 0 of all other idle motions
};

struct Mobility {
  std::vector<IdleMotion> idle;
  MatrixX free;              ///< the other free motions, columns by freedom; the structure stands where there are none
  double largest_free = 0;   ///< σ
  double smallest_held = 1;  ///< σ of what counts as held; near 0 the structure is nearly a mechanism
  VectorX softest;           ///< that motion by freedom, where smallest_held < 1e-5 was found
};

/// `resists`, by spring: whether it counts as a condition.
Mobility mobility_of(const Model&, const std::vector<char>& resists);

/// Of the idle motions those of single pieces that no condition sees, at little cost: hinged nodes and hinged members.
std::vector<IdleMotion> loose_pieces(const Model&, const std::vector<char>& resists);

}  // namespace deflect::frame
