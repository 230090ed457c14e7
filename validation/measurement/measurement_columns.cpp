#include "validation/measurement/measurement_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <string>

#include "validation/measurement/column_units.h"

namespace deflect::measurement {
namespace {

constexpr const SixNames* machine_columns[] = {&pose_columns, &load_columns, &displacement_columns};

std::vector<std::string> fixed_columns(const Instruments& known) {
  std::vector<std::string> names = {"pose"};
  if (!known.stationary)
    for (const SixNames* six : machine_columns) names.insert(names.end(), six->begin(), six->end());
  for (const char* name : {"sigma_u_mm", "sigma_th_rad", "sequence", "temperature_C"}) names.emplace_back(name);
  for (const SensorChannel& sensor : known.sensors) names.push_back(sensor_column(sensor));
  for (const std::string& load_case : known.load_cases) names.push_back("load." + load_case);
  for (const std::string& point : known.load_points)
    for (std::size_t i = 0; i < 6; ++i) names.push_back(load_column(point, i));
  return names;
}

/// The number in a name that begins with q and a number, as of a joint coordinate; 0 otherwise.
std::size_t joint_number(std::string_view name) {
  std::size_t number = 0;
  if (name.starts_with('q') || name.starts_with('Q'))
    std::from_chars(name.data() + 1, name.data() + name.size(), number);
  return number;
}

/// "a, b, c, …"
std::string few(std::vector<std::string> names, std::size_t most) {
  if (names.size() > most) names.resize(most), names.push_back("…");
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Whether only a machine's file has this column.
bool of_machines(const std::string& name) {
  return joint_number(name) > 0 ||
         std::any_of(std::begin(machine_columns), std::end(machine_columns),
                     [&](const SixNames* six) { return std::find(six->begin(), six->end(), name) != six->end(); });
}

/// The columns by the names of the contract.
class ContractColumns {
 public:
  ContractColumns(const CsvTable& table, const Instruments& known)
      : table_(table), instruments_(known), units_(has_units_row()) {
    const std::vector<std::string> fixed = fixed_columns(known);
    for (std::size_t column = 0; column < table.header().size(); ++column) {
      const std::string& written = table.header()[column];
      const std::optional<NamedColumn> named = known_column(column, fixed);
      if (!named) refuse(column, fixed);
      if (is_note(written) || is_note(named->name)) {
        notes_.push_back(column);
        continue;
      }
      if (const auto [same, is_new] = columns_.emplace(named->name, ReadColumn{column, named->factor, named->offset});
          !is_new)
        table.refuse_header(fmt::format("columns '{}' and '{}' are both {}: keep one",
                                        excerpt(table.header()[same->second.index]), excerpt(written), named->name));
      if (!named->as_it_stands())
        how_read_.push_back(
            fmt::format("column '{}' is read in {} and becomes {}", excerpt(written), named->unit, named->name));
      else if (written != named->name)
        how_read_.push_back(fmt::format("column '{}' is read as {}", excerpt(written), named->name));
    }
    if (units_) how_read_.push_back(fmt::format("line {} holds the units of the columns", table.line(0)));
  }

  bool has_units() const { return units_; }
  const std::vector<std::size_t>& notes() const { return notes_; }
  const std::vector<std::string>& how_read() const { return how_read_; }
  const std::map<std::string, ReadColumn>& all() const { return columns_; }

  std::optional<ReadColumn> find(const std::string& name) const {
    const auto found = columns_.find(name);
    return found == columns_.end() ? std::nullopt : std::optional(found->second);
  }
  const std::string& written(const ReadColumn& column) const { return table_.header()[column.index]; }

 private:
  /// What the column is called here; nothing where it is unknown.
  std::optional<NamedColumn> known_column(std::size_t column, const std::vector<std::string>& fixed) const {
    const std::optional<NamedColumn> named =
        named_column(table_.header()[column], units_ ? table_.text(0, column) : "", instruments_);
    const bool elsewhere = named && instruments_.stationary && of_machines(named->name) &&
                           std::find(fixed.begin(), fixed.end(), named->name) == fixed.end();
    return elsewhere ? std::nullopt : named;
  }

  /// A row without numbers whose cells are units, two or more and twice as many as there are other words.
  bool has_units_row() const {
    if (table_.rows() < 2) return false;
    std::size_t units = 0, others = 0;
    for (std::size_t column = 0; column < table_.header().size(); ++column) {
      const std::string_view cell = table_.text(0, column);
      if (cell.empty() || is_note(table_.header()[column])) continue;
      if (table_.is_number(0, column)) return false;
      const std::optional<NamedColumn> named = named_column(table_.header()[column], {}, instruments_);
      if (named && (named->name == "pose" || named->name == "sequence")) continue;
      ++(is_unit(cell) ? units : others);
      units -= cell == "-";
    }
    return units > 1 && units >= 2 * others;
  }

  [[noreturn]] void refuse(std::size_t column, std::vector<std::string> known) const {
    const std::string& written = table_.header()[column];
    if (units_ && !is_unit(table_.text(0, column)))
      table_.refuse(0, column,
                    fmt::format("'{}' is no unit: write one such as mm, um, N, Nmm, deg or rad, or '-' for none",
                                excerpt(table_.text(0, column))));
    if (units_ && named_column(written, {}, instruments_) && !table_.text(0, column).empty())
      table_.refuse(
          0, column,
          fmt::format("the unit below is '{}': name and unit must say the same", excerpt(table_.text(0, column))));
    refuse_other_subject(known);
    const std::size_t number = std::max<std::size_t>(joint_number(written), 1);
    if (!instruments_.stationary)
      known.insert(known.end(), {joint_column(number - 1, true), joint_column(number - 1, false)});
    table_.refuse_header(unknown_column(written, known));
  }

  /// Where most columns are unknown, and three or more, none of them is a slip of the pen.
  void refuse_other_subject(const std::vector<std::string>& known) const {
    std::vector<std::string> unknown;
    std::size_t all = 0;
    for (std::size_t column = 0; column < table_.header().size(); ++column) {
      const std::string& written = table_.header()[column];
      if (is_note(written)) continue;
      ++all;
      const bool coordinate = !instruments_.stationary && joint_number(written) > 0;
      if (!coordinate && !known_column(column, known) && !is_misspelled(written, known))
        unknown.push_back(fmt::format("'{}'", excerpt(written)));
    }
    if (unknown.size() < 3 || 2 * unknown.size() <= all) return;
    table_.refuse_header(
        fmt::format("{} of {} columns are unknown ({}): are these readings of something else? The columns are {}; the "
                    "names of remarks begin with note",
                    unknown.size(), all, few(unknown, 5), few(known, 40)));
  }

  const CsvTable& table_;
  const Instruments& instruments_;
  bool units_;
  std::map<std::string, ReadColumn> columns_;
  std::vector<std::size_t> notes_;
  std::vector<std::string> how_read_;
};

struct JointColumn {
  ReadColumn column;
  bool rotates;
};

/// By number, counted from 1.
std::map<std::size_t, JointColumn> joint_columns(const CsvTable& table, const ContractColumns& columns) {
  std::map<std::size_t, JointColumn> joints;
  for (const auto& [name, column] : columns.all()) {
    const std::size_t number = joint_number(name);
    if (number == 0) continue;
    const std::string angle = joint_column(number - 1, true), slider = joint_column(number - 1, false);
    if (!joints.emplace(number, JointColumn{column, name == angle}).second)
      table.refuse_header(fmt::format(
          "columns '{}' and '{}' are one coordinate: an angle has rad, a slider mm, keep one", angle, slider));
  }
  return joints;
}

std::string missing_of(const ContractColumns& columns, const SixNames& names, std::size_t count) {
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < count; ++i)
    if (!columns.find(names[i])) missing.push_back(names[i]);
  return fmt::format("{}", fmt::join(missing, ", "));
}

void command_columns(const CsvTable& table, const ContractColumns& known, MeasurementColumns& columns) {
  const std::map<std::size_t, JointColumn> joints = joint_columns(table, known);
  const auto posed = std::find_if(pose_columns.begin(), pose_columns.end(),
                                  [&](const std::string& name) { return known.find(name).has_value(); });
  if (joints.empty()) {
    if (posed == pose_columns.end())
      table.refuse_header(
          "the commanded pose is missing: columns x_mm, y_mm, z_mm, roll_deg, pitch_deg, yaw_deg, or "
          "the joint coordinates q1_rad (q1_mm of a slider) and so on");
    if (const std::string missing = missing_of(known, pose_columns, 6); !missing.empty())
      table.refuse_header(
          fmt::format("columns missing: {}; a commanded pose has all six of x_mm, y_mm, z_mm, "
                      "roll_deg, pitch_deg, yaw_deg (write 0 where an angle is zero)",
                      missing));
    for (const std::string& name : pose_columns) columns.command.push_back(*known.find(name));
    return;
  }
  if (posed != pose_columns.end())
    table.refuse_header(
        fmt::format("columns '{}' and '{}': the pose is commanded by six numbers or by joint "
                    "coordinates, keep one of the two",
                    known.written(*known.find(*posed)), known.written(joints.begin()->second.column)));
  for (const auto& [number, joint] : joints) {
    if (number != columns.command.size() + 1)
      table.refuse_header(
          fmt::format("column '{}' without a column of joint coordinate {}: they are numbered from 1 "
                      "without gaps",
                      known.written(joint.column), columns.command.size() + 1));
    columns.command.push_back(joint.column);
    columns.joint_rotates.push_back(joint.rotates);
  }
}

void other_columns(const ContractColumns& known, MeasurementColumns& columns) {
  columns.sigma_u = known.find("sigma_u_mm");
  columns.sigma_th = known.find("sigma_th_rad");
  if (const auto sequence = known.find("sequence")) columns.sequence = sequence->index;
  columns.temperature = known.find("temperature_C");
  columns.notes = known.notes();
  columns.first_row = known.has_units() ? 1 : 0;
  columns.how_read = known.how_read();
}

[[noreturn]] void refuse_without_sensors(const CsvTable& table) {
  table.refuse_header(
      "the measured thing is a frame that has no sensors, so nothing of this file can be compared: describe them in "
      "the "
      "frame file, as in 'sensors: {lvdt: {node: B, direction: uz}}'");
}

/// A frame is loaded and, unless it is a plan, read.
void require_stationary(const CsvTable& table, const Instruments& instruments, bool plan,
                        const MeasurementColumns& columns) {
  std::vector<std::string> sensors, cases;
  for (const SensorChannel& sensor : instruments.sensors) sensors.push_back(sensor_column(sensor));
  for (const std::string& name : instruments.load_cases) cases.push_back("load." + name);
  for (const std::string& point : instruments.load_points) cases.push_back(load_column(point, 0));
  if (!plan && columns.sensors.empty())
    table.refuse_header(
        fmt::format("no sensor of the frame is read: at least one of the columns {} is wanted", few(sensors, 8)));
  if (columns.load_cases.empty() && columns.load_points.empty())
    table.refuse_header(
        fmt::format("no load: at least one column with a factor on a load case or with a load at a node is wanted ({})",
                    few(cases, 8)));
}

}  // namespace

std::string joint_column(std::size_t joint, bool rotates) {
  return fmt::format("q{}_{}", joint + 1, rotates ? "rad" : "mm");
}

MeasurementColumns measurement_columns(const CsvTable& table, const Instruments& instruments, bool plan) {
  if (instruments.stationary && instruments.sensors.empty()) refuse_without_sensors(table);
  const ContractColumns known(table, instruments);
  MeasurementColumns columns;
  for (const SensorChannel& sensor : instruments.sensors)
    if (const auto same = named_column(sensor_column(sensor));
        same && !(instruments.stationary && of_machines(same->name)))
      table.refuse_header(fmt::format(
          "the device calls a sensor '{}', and '{}' is a column of every file: give the sensor another name",
          sensor.name, sensor_column(sensor)));
  for (const SensorChannel& sensor : instruments.sensors)
    if (const auto column = known.find(sensor_column(sensor))) columns.sensors.push_back({sensor, *column});
  for (const std::string& point : instruments.load_points) {
    LoadPointColumns at{point, {}};
    for (std::size_t i = 0; i < 6; ++i) at.load[i] = known.find(load_column(point, i));
    if (std::any_of(at.load.begin(), at.load.end(), [](const auto& c) { return c.has_value(); }))
      columns.load_points.push_back(std::move(at));
  }
  for (const std::string& load_case : instruments.load_cases)
    if (const auto column = known.find("load." + load_case)) columns.load_cases.push_back({load_case, *column});
  if (const auto label = known.find("pose")) columns.pose = label->index;
  other_columns(known, columns);
  if (instruments.stationary) {
    require_stationary(table, instruments, plan, columns);
    return columns;
  }
  command_columns(table, known, columns);
  if (!columns.pose) table.refuse_header("column 'pose' is missing: a label for every approach of a pose");
  const std::string missing = missing_of(known, load_columns, 3);
  const bool loads_elsewhere =
      !columns.load_points.empty() &&
      missing == fmt::format("{}", fmt::join(load_columns.begin(), load_columns.begin() + 3, ", "));
  if (!missing.empty() && !loads_elsewhere)
    table.refuse_header(
        fmt::format("columns missing: {}; a load has all three forces (write 0 where one is zero)", missing));
  for (std::size_t i = 0; i < 6; ++i) {
    columns.load[i] = known.find(load_columns[i]);
    columns.displacement[i] = known.find(displacement_columns[i]);
  }
  if (!plan && columns.sensors.empty() &&
      std::none_of(columns.displacement.begin(), columns.displacement.end(),
                   [](const auto& c) { return c.has_value(); }))
    table.refuse_header(fmt::format("no displacement is measured: at least one of the columns {} is wanted",
                                    fmt::join(displacement_columns, ", ")));
  return columns;
}

}  // namespace deflect::measurement
