// Whether a frame can stand, from its geometry alone and without rounding.
//
// Unknowns: a small rigid motion (translation, rotation) of every node and of every member. A motion without strain
// moves each member as one rigid body, whatever its section; the ends of the member follow their nodes in the freedoms
// that are not released; supports, springs and links hold their freedoms; constraints hold. The rows of all these form
// the kinematic matrix C. The frame has no motion without strain ⇔ C has full column rank.
//
// Coordinates, directions, factors are binary fractions, and member axes need no normalisation for this purpose (x = b
// − a, y = (x·x) r − (x·r) x, z = x × y), so that C has rational entries: its rank and null space are computed by
// Gauss's elimination in the integers modulo the prime p = 2⁶¹ − 1. The rank modulo p is never larger than the true
// one, and smaller only where p divides a minor: by chance once in 1e18.
//
// The motions without strain decide what is right:
//   stands   there is none;
//   idle     no node and no end of a member translates: what is left are rotations of nodes and spins of members about
//            their own axes. They are harmless; the frame is solved, the motion is held and noted;
//   driven   as idle, but a load does work on such a rotation: refused;
//   moves    a node or the end of a member translates: refused.
#pragma once

#include <vector>

#include "msa/frame/file/frame_description.h"

namespace deflect::attack {

enum class Standing { stands, idle, driven, moves };
inline constexpr const char* standing_names[] = {"stands", "idle", "driven", "moves"};

struct StandingVerdict {
  Standing standing = Standing::stands;
  int motions = 0;           ///< independent ones
  std::vector<int> to_hold;  ///< freedoms of nodes (6 · node + freedom) that hold every motion which moves a node
  std::vector<bool> turns;   ///< by node: a motion without strain turns it, so that its rotation has no value
};

/// Of a frame with coordinates that are few-digit binary fractions (random_frame.h); loads are those of all cases.
StandingVerdict can_stand(const frame::FrameDescription&);

}  // namespace deflect::attack
