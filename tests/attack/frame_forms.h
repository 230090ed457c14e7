// The same frame in other words: another size, another unit of force, another order, other axes. What its answers
// become is said at each.
#pragma once

#include <optional>

#include "msa/frame/file/frame_description.h"
#include "tests/attack/random_frame.h"

namespace deflect::attack {

/// All lengths times s, moduli the same: forces s², moments s³, springs s and s³. Displacements become s times what
/// they were, rotations stay.
frame::FrameDescription scaled(frame::FrameDescription, double s);

/// All forces, moduli and spring stiffnesses times c: displacements stay.
frame::FrameDescription in_force_unit(frame::FrameDescription, double c);

/// Nodes, members, supports and the rest in any order, members with their ends exchanged where `exchange`:
/// displacements by name stay. An exchanged member has its local y as before, its z turned round.
frame::FrameDescription shuffled(frame::FrameDescription, Dice&);

/// The axes of a structure turned or mirrored by an orthogonal matrix R: translations become R u, rotations det(R) R θ.
/// Supports, partial links and constraints become linear constraints where R is no signed permutation; there is no such
/// frame (nullopt) where a spring then would not stand along base axes.
std::optional<frame::FrameDescription> turned(const frame::FrameDescription&, const Matrix3& R);

/// One of the 48 signed permutations.
Matrix3 signed_permutation(Dice&);
Matrix3 any_rotation(Dice&);

}  // namespace deflect::attack
