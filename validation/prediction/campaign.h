// Plans of measurements: which poses, which loads, in which order.
//
//   paper   the points of the workspace, +F along x, y, z; for a cube, the readings of the paper (27)
//   cycle   the points, a loop 0 → F → −F → 0 in steps of F/4 along x, y, z, in sequence (432 for a cube)
//   rich    the points and six tilted poses within the workspace, ±F, ±F/2, ±F/5 along each axis and ±M about each, all
//           of it twice (720 for a cube)
//   random  twenty tilted poses within the workspace, fourteen loads each of random direction, F/5 … F (280)
//
// Tilts are up to 7.5 deg about each axis where the mechanism has six degrees of freedom, else 0; M = F · 20 mm.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "msa/mechanism/description.h"
#include "validation/measurement/measurements.h"

namespace deflect::measurement {
class Random;
}

namespace deflect::prediction {

/// Moments of plans over their forces, m.
inline constexpr double lever = 0.02;

inline constexpr const char* campaign_names[] = {"paper", "cycle", "rich", "random"};

/// The plan of that name for the device's workspace (workspace.h): poses, loads and sequence. Random poses that the
/// device cannot reach are drawn again; a workspace point that it cannot reach throws ModelError. `force`: F in N.
measurement::Measurements campaign(const std::string& name, const Mechanism&, double force, std::uint64_t seed);

/// Poses drawn by lot within the device's workspace, x y z roll pitch yaw in mm and deg, with those tilts.
std::vector<Vector6> tilted_poses(const Mechanism&, int count, measurement::Random&);

}  // namespace deflect::prediction
