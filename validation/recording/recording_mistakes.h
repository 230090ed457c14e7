// The usual mistakes of recording: units, signs, axes, columns.
#pragma once

#include <vector>

#include "validation/recording/recorded.h"

namespace deflect::recording {

/// Of displacements and loads: those that would change these data.
std::vector<Correction> mistaken_readings(const measurement::Measurements&);

/// Of commanded poses or joint coordinates: those that would change these data.
std::vector<Correction> mistaken_poses(const measurement::Measurements&);

/// Lengths of poses in another unit: of such poses hardly any can be reached as they stand.
std::vector<Correction> mistaken_pose_lengths(const measurement::Measurements&);

/// Every pose off by the same, mm in base axes.
Correction shifted_poses(const Vector3& by_mm);

/// Every force at T + p, m in base axes.
Correction forces_elsewhere(const Vector3& p);

}  // namespace deflect::recording
