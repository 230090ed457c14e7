// Whether displacements that were computed in the undeformed shape are small enough for that.
//
// Linear geometry takes 1 for cos θ: it leaves out θ²/2 of a length that turns by θ (rad). It writes equilibrium with
// the lever arms of the unloaded shape, which displacements u change by u/size. It is called in question above θ = 0.1
// (0.5 %), where θ is the largest rotation of a node or of the line between the ends of a member, and above u/size =
// 0.05.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "msa/base/geometry.h"
#include "msa/base/spatial.h"

namespace deflect::report {

/// Of a structure: m, rad.
struct Displacements {
  std::vector<Vector3> points, moved, turned;              ///< by point: place, displacement, rotation
  std::vector<std::pair<std::size_t, std::size_t>> lines;  ///< between points
};

/// A sentence with the sizes and the remedy; nothing where they are small, or the geometry is finite.
std::optional<std::string> large_displacement_note(const Displacements&, Geometry, const std::string& remedy);

}  // namespace deflect::report
