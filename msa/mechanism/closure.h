// Closes loops: joint coordinates by the Gauss–Newton method with minimum-norm steps from a neighbouring state, so that
// redundant constraints and free spins do no harm.
#pragma once

#include <optional>
#include <string>

#include "msa/mechanism/walk.h"

namespace deflect {

/// Result of close_loops(). With a pose of the platform all joint coordinates are unknowns; without one the actuated
/// coordinates stay fixed and the legs must agree with each other.
struct Closed {
  Trace trace;
  double shift = 0, turn = 0;  ///< gap left: m, rad
  bool closed = false;         ///< gap below 1e-8 of the length, the rounding of numbers in files
};

/// Changes `states` until all loops close. `length` (m) weighs rotations against translations. No step turns a joint by
/// more than 0.3 rad or moves one by more than 0.3 `length`.
Closed close_loops(std::span<const LegParts>, std::vector<JointState>& states, const std::optional<Frame>& platform,
                   double length);

/// Twists [δ; θ] at p_W that a leg's end can make while its inner loops stay closed, and those that it cannot:
/// orthonormal bases in weighed coordinates (rotations times `length`).
struct Reach {
  Matrix6X can, cannot;
};
Reach reach(const Trace&, std::size_t leg, const Vector3& p_W, double length);

}  // namespace deflect
