// Where a table has the columns of a measurement file.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "validation/measurement/column_names.h"
#include "validation/measurement/csv.h"
#include "validation/measurement/measurements.h"

namespace deflect::measurement {

/// A column and how its numbers become those of the contract: factor · (number + offset).
struct ReadColumn {
  std::size_t index = 0;
  double factor = 1, offset = 0;
};

struct SensorColumn {
  SensorChannel sensor;
  ReadColumn column;
};

struct LoadPointColumns {
  std::string name;
  std::array<std::optional<ReadColumn>, 6> load;
};

struct LoadCaseColumn {
  std::string name;
  ReadColumn column;
};

struct MeasurementColumns {
  std::optional<std::size_t> pose;  ///< only a stationary subject's file may have none
  std::vector<ReadColumn> command;  ///< x y z roll pitch yaw, or the joint coordinates in order
  std::vector<bool> joint_rotates;  ///< of the joint coordinates; empty for poses
  std::array<std::optional<ReadColumn>, 6> load, displacement;
  std::vector<SensorColumn> sensors;
  std::vector<LoadPointColumns> load_points;
  std::vector<LoadCaseColumn> load_cases;
  std::optional<ReadColumn> sigma_u, sigma_th, temperature;
  std::optional<std::size_t> sequence;
  std::vector<std::size_t> notes;
  std::size_t first_row = 0;          ///< 1 where the first one holds units
  std::vector<std::string> how_read;  ///< "column 'ux_in' is read in in and becomes ux_mm"
};

/// Throws InputError for unknown columns, missing ones and poses commanded in two ways. A plan wants no displacement.
MeasurementColumns measurement_columns(const CsvTable&, const Instruments& known, bool plan);

/// "q3_rad", "q3_mm": the column of the joint coordinate, counted from 0 here and from 1 there.
std::string joint_column(std::size_t joint, bool rotates);

}  // namespace deflect::measurement
