// The domain of validation, where readings were compared, beside the domain of use, where the model will be asked.
//
// Variables are the position and orientation of the poses, or the joint coordinates, and the loads. A point of use is
// inside where it lies in the convex hull of the validation's points: of positions (or joint coordinates), of loads
// together with no load, under which every displacement is zero. Outside, the distance to the hull says how far the
// model is extrapolated (W. Oberkampf, T. Trucano, Verification and validation benchmarks, Nucl. Eng. Des. 238 (2008)
// 716–743, on the validation domain and the application domain).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/measurement/measurements.h"

namespace deflect::validity {

/// One variable's range, in its unit.
struct Range {
  std::string name, unit;
  double low = 0, high = 0;          ///< in validation
  double use_low = 0, use_high = 0;  ///< in use; equal to those without a plan of use
  bool outside() const { return use_low < low || use_high > high; }
};

/// Ranges of what varies in either; poses and loads.
std::vector<Range> ranges(const measurement::Measurements& validation, const measurement::Measurements* use);

/// One point of use.
struct UsePoint {
  std::size_t reading = 0;
  double pose_distance = 0;  ///< to the hull of positions, mm; of joint coordinates in shares of their ranges; 0 inside
  double load_distance = 0;  ///< to the hull of loads, as a share of the largest load of validation; 0 inside
  bool inside() const { return pose_distance == 0 && load_distance == 0; }
};

std::vector<UsePoint> use_points(const measurement::Measurements& validation, const measurement::Measurements& use);

}  // namespace deflect::validity
