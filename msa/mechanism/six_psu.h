// Kinematics of the 6-PSU: six vertical guideways, a constant link from each guideway's tip to the platform.
#pragma once

#include <array>

#include "msa/mechanism/description.h"

namespace deflect {

/// The points of one leg in the base frame (m): A base joint, B tip of the guideway, C platform joint.
struct SixPsuLeg {
  Vector3 p_WA, p_WB, p_WC;
  Vector3 radial;     ///< horizontal unit vector from the base axis to A, as drawn
  double slider = 0;  ///< L1 = |AB|
};

/// The data of a leg that do not depend on the pose: A, C in the platform's axes, the link's length.
struct SixPsuDrawing {
  int leg = 0;
  Vector3 p_WA, p_TC, radial;
  double link_length = 0;
};
SixPsuDrawing drawing_of(const SixPsu&, int leg);

/// Inverse kinematics, ball joint below the platform: L1 = d_z − √(L2² − d_x² − d_y²), d = C − A. `leg` is 1-based.
/// Throws ModelError with the leg where its link does not reach or its slider leaves its range.
SixPsuLeg leg_at(const SixPsu&, int leg, const Pose&);
SixPsuLeg leg_at(const SixPsu&, const SixPsuDrawing&, const Pose&);

/// The untilted pose above the base centre at which every slider, as drawn, has the length `slider`. Throws ModelError
/// when the links cannot reach from the base circle to the platform circle.
Pose centred_pose(const SixPsu&, double slider);

struct ForwardKinematics {
  Pose pose;
  bool converged = false;
  int iterations = 0;
  double closure_error = 0;  ///< largest | |BC| − L2 | in m
};

/// Forward kinematics by Newton's method on |C_i − B_i|² = L2² from `start`. Of the up to 40 assembly modes it finds
/// the one connected to the start. Not converged: no assembly near the start fits the sliders, or the pose is singular.
ForwardKinematics forward_kinematics(const SixPsu&, const std::array<double, 6>& sliders, const Pose& start);

}  // namespace deflect
