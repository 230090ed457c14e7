#include "validation/measurement/measurement_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <string>

namespace deflect {
namespace {

std::vector<std::string> fixed_columns() {
  std::vector<std::string> names = {"pose"};
  for (const SixNames* six : {&pose_columns, &load_columns, &displacement_columns})
    names.insert(names.end(), six->begin(), six->end());
  for (const char* name : {"sigma_u_mm", "sigma_th_rad", "sequence", "temperature_C"}) names.emplace_back(name);
  return names;
}

/// The number in a name that begins with q and a number, as of a joint coordinate; 0 otherwise.
std::size_t joint_number(std::string_view name) {
  std::size_t number = 0;
  if (name.starts_with('q') || name.starts_with('Q'))
    std::from_chars(name.data() + 1, name.data() + name.size(), number);
  return number;
}

struct JointColumn {
  std::size_t column;
  bool rotates;
};

/// By number, counted from 1. Refuses every name that the contract does not know.
std::map<std::size_t, JointColumn> joint_columns(const CsvTable& table) {
  const std::vector<std::string> fixed = fixed_columns();
  std::map<std::size_t, JointColumn> joints;
  for (std::size_t column = 0; column < table.header().size(); ++column) {
    const std::string& name = table.header()[column];
    if (is_note(name) || std::find(fixed.begin(), fixed.end(), name) != fixed.end()) continue;
    const std::size_t number = std::max<std::size_t>(joint_number(name), 1);
    const std::string angle = joint_column(number - 1, true), slider = joint_column(number - 1, false);
    if (name != angle && name != slider) {
      std::vector<std::string> known = fixed;
      known.insert(known.end(), {angle, slider});
      table.refuse_header(unknown_column(name, known));
    }
    if (!joints.emplace(number, JointColumn{column, name == angle}).second)
      table.refuse_header(fmt::format(
          "columns '{}' and '{}' are one coordinate: an angle has rad, a slider mm, keep one", angle, slider));
  }
  return joints;
}

std::string missing_of(const CsvTable& table, const SixNames& names, std::size_t count) {
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < count; ++i)
    if (!table.column(names[i])) missing.push_back(names[i]);
  return fmt::format("{}", fmt::join(missing, ", "));
}

void command_columns(const CsvTable& table, MeasurementColumns& columns) {
  const std::map<std::size_t, JointColumn> joints = joint_columns(table);
  const auto posed = std::find_if(pose_columns.begin(), pose_columns.end(),
                                  [&](const std::string& name) { return table.column(name).has_value(); });
  if (joints.empty()) {
    if (posed == pose_columns.end())
      table.refuse_header(
          "the commanded pose is missing: columns x_mm, y_mm, z_mm, roll_deg, pitch_deg, yaw_deg, or "
          "the joint coordinates q1_rad (q1_mm of a slider) and so on");
    if (const std::string missing = missing_of(table, pose_columns, 6); !missing.empty())
      table.refuse_header(
          fmt::format("columns missing: {}; a commanded pose has all six of x_mm, y_mm, z_mm, "
                      "roll_deg, pitch_deg, yaw_deg (write 0 where an angle is zero)",
                      missing));
    for (const std::string& name : pose_columns) columns.command.push_back(*table.column(name));
    return;
  }
  if (posed != pose_columns.end())
    table.refuse_header(
        fmt::format("columns '{}' and '{}': the pose is commanded by six numbers or by joint "
                    "coordinates, keep one of the two",
                    *posed, table.header()[joints.begin()->second.column]));
  for (const auto& [number, joint] : joints) {
    if (number != columns.command.size() + 1)
      table.refuse_header(
          fmt::format("column '{}' without a column of joint coordinate {}: they are numbered from 1 "
                      "without gaps",
                      table.header()[joint.column], columns.command.size() + 1));
    columns.command.push_back(joint.column);
    columns.joint_rotates.push_back(joint.rotates);
  }
}

}  // namespace

std::string joint_column(std::size_t joint, bool rotates) {
  return fmt::format("q{}_{}", joint + 1, rotates ? "rad" : "mm");
}

MeasurementColumns measurement_columns(const CsvTable& table, bool plan) {
  MeasurementColumns columns;
  command_columns(table, columns);
  const auto label = table.column("pose");
  if (!label) table.refuse_header("column 'pose' is missing: a label for every approach of a pose");
  columns.pose = *label;
  if (const std::string missing = missing_of(table, load_columns, 3); !missing.empty())
    table.refuse_header(
        fmt::format("columns missing: {}; a load has all three forces (write 0 where one is zero)", missing));
  for (std::size_t i = 0; i < 6; ++i) {
    columns.load[i] = table.column(load_columns[i]);
    columns.displacement[i] = table.column(displacement_columns[i]);
  }
  if (!plan && std::none_of(columns.displacement.begin(), columns.displacement.end(),
                            [](const auto& c) { return c.has_value(); }))
    table.refuse_header(fmt::format("no displacement is measured: at least one of the columns {} is wanted",
                                    fmt::join(displacement_columns, ", ")));
  columns.sigma_u = table.column("sigma_u_mm");
  columns.sigma_th = table.column("sigma_th_rad");
  columns.sequence = table.column("sequence");
  columns.temperature = table.column("temperature_C");
  for (std::size_t column = 0; column < table.header().size(); ++column)
    if (is_note(table.header()[column])) columns.notes.push_back(column);
  return columns;
}

}  // namespace deflect
