// Closing loops: joint coordinates by Newton (Gauss-Newton of least length, so that redundant constraints and idle
// spins do no harm) from a neighbouring state.
#pragma once

#include <optional>
#include <string>

#include "msa/mechanism/walk.h"

namespace deflect {

/// What is to hold: a pose of the platform (coordinates of every joint are sought), or no pose (actuated coordinates
/// stay, and the legs must agree with one another).
struct Closed {
  Trace trace;
  double shift = 0, turn = 0;  ///< what is left open: m, rad
  bool closed = false;         ///< to 1e-8 of the length, the rounding of numbers in files
};

/// Moves `states` until all loops close. `length` (m) weighs turns against shifts. No step turns a joint by more than
/// 0.3 rad or shifts one by more than 0.3 lengths.
Closed close_loops(std::span<const LegParts>, std::vector<JointState>& states, const std::optional<Frame>& platform,
                   double length);

/// Twists [δ; θ] at p_W that a leg's end can make while its inner loops stay closed: an orthonormal basis in weighed
/// coordinates (rotations times `length`), and of those that it cannot.
struct Reach {
  Matrix6X can, cannot;
};
Reach reach(const Trace&, std::size_t leg, const Vector3& p_W, double length);

}  // namespace deflect
