// Poses to be validated, from a CSV file.
#pragma once

#include <filesystem>
#include <vector>

#include "validation/studies/workspace.h"

namespace deflect::studies {

/// Columns in any order: x_mm, y_mm, z_mm; optional roll_deg, pitch_deg, yaw_deg (0 without them) and pose,
/// the label (without it the rows are numbered from 0); columns whose name begins with "note" are not read.
/// Throws InputError with file and line for any other column, a missing one, a cell that is not a finite
/// number, and a label that is empty or stands twice.
std::vector<ValidationPoint> read_points(const std::filesystem::path&);

}  // namespace deflect::studies
