// Plans of measurements: which poses, which loads, in which order.
//
//   paper   the points of the workspace, +F along x, y, z: of a cube what the paper compares (27 readings)
//   cycle   the points, a loop 0 → F → −F → 0 in steps of F/4 along x, y, z, in sequence (of a cube 432)
//   rich    the points and six tilted poses within the workspace, ±F, ±F/2, ±F/5 along each axis and ±M about each,
//           all of it twice (of a cube 720)
//   random  twenty tilted poses within the workspace, fourteen loads each of random direction, F/5 … F (280)
//
// Tilts are up to 7.5 deg about each axis where the mechanism has six freedoms, none otherwise; M = F · 20 mm.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "msa/mechanism/description.h"
#include "validation/measurement/measurements.h"

namespace deflect::prediction {

inline constexpr const char* campaign_names[] = {"paper", "cycle", "rich", "random"};

/// The plan of that name for the device's workspace (workspace.h): poses, loads and sequence. Poses that the device
/// cannot reach are drawn anew; a point that it cannot reach is a ModelError. F in N.
measurement::Measurements campaign(const std::string& name, const Mechanism&, double force, std::uint64_t seed);

}  // namespace deflect::prediction
