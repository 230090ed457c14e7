// Where a table has the columns of a measurement file.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "validation/measurement/column_names.h"
#include "validation/measurement/csv.h"

namespace deflect {

struct MeasurementColumns {
  std::size_t pose = 0;
  std::vector<std::size_t> command;  ///< x y z roll pitch yaw, or the joint coordinates in order
  std::vector<bool> joint_rotates;   ///< of the joint coordinates; empty for poses
  std::array<std::optional<std::size_t>, 6> load, displacement;
  std::optional<std::size_t> sigma_u, sigma_th, sequence, temperature;
  std::vector<std::size_t> notes;
};

/// Throws InputError for unknown columns, missing ones and poses commanded in two ways. A plan wants no displacement.
MeasurementColumns measurement_columns(const CsvTable&, bool plan = false);

/// "q3_rad", "q3_mm": the column of the joint coordinate, counted from 0 here and from 1 there.
std::string joint_column(std::size_t joint, bool rotates);

}  // namespace deflect
