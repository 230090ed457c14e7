// Small motions of a rigid body in words.
#pragma once

#include <string>

#include "msa/base/spatial.h"

namespace deflect {

/// Describes the twist [δ; θ] (m, rad) at T, of any magnitude: "translation along (0, 0, 1)", or "rotation about (0, 0,
/// 1) through T + (10, 0, 0) mm", with ", advancing 3 mm per rad" for a screw. A rotation that has no noticeable effect
/// within `length` (m) is ignored.
std::string motion_text(const Vector6& d_T_W, double length);

}  // namespace deflect
