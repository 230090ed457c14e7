#include "validation/measurement/measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string_view>
#include <unordered_map>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/spatial.h"
#include "validation/measurement/csv.h"
#include "validation/measurement/measurement_columns.h"

namespace deflect {
namespace {

constexpr double absolute_zero_C = -273.15;

class Reader {
 public:
  Reader(const CsvTable& table, const std::string& origin, bool plan)
      : table_(table), columns_(measurement_columns(table, plan)) {
    m_.origin = origin;
    m_.joint_rotates = columns_.joint_rotates;
    m_.temperature_recorded = columns_.temperature.has_value();
    for (const std::size_t column : columns_.notes) m_.note_columns.push_back(table.header()[column]);
  }

  Measurements read() {
    m_.readings.reserve(table_.rows());
    for (std::size_t row = 0; row < table_.rows(); ++row) m_.readings.push_back(reading(row));
    return std::move(m_);
  }

 private:
  Reading reading(std::size_t row) {
    Reading r;
    r.line = table_.line(row);
    r.pose = group(row);
    for (std::size_t i = 0; i < 6; ++i) {
      if (const auto column = columns_.load[i])
        r.load(static_cast<Eigen::Index>(i)) = table_.number(row, *column) / (i < 3 ? 1 : 1e3);
      if (const auto value = number(row, columns_.displacement[i])) r.displacement[i] = *value / (i < 3 ? 1e3 : 1);
    }
    r.sigma_u = sigma(row, columns_.sigma_u, 1e3);
    r.sigma_th = sigma(row, columns_.sigma_th, 1);
    if (columns_.sequence) r.sequence = sequence(row, *columns_.sequence);
    if (const auto t = number(row, columns_.temperature)) {
      if (*t < absolute_zero_C) table_.refuse(row, *columns_.temperature, "below absolute zero; °C are wanted");
      r.temperature_C = *t;
    }
    for (const std::size_t column : columns_.notes) r.notes.emplace_back(table_.text(row, column));
    return r;
  }

  /// Index of the row's pose group, which is made where the label is new.
  std::size_t group(std::size_t row) {
    const std::string_view label = table_.text(row, columns_.pose);
    if (label.empty()) table_.refuse(row, columns_.pose, "the label is empty: give every approach of a pose a label");
    const auto [found, is_new] = group_of_.emplace(label, m_.poses.size());
    if (is_new)
      m_.poses.push_back(new_group(row));
    else
      check_same_command(row, m_.poses[found->second].readings.front());
    m_.poses[found->second].readings.push_back(row);
    return found->second;
  }

  PoseGroup new_group(std::size_t row) const {
    PoseGroup group;
    group.label = table_.text(row, columns_.pose);
    const std::vector<std::size_t>& columns = columns_.command;
    if (m_.by_joints()) group.joints.resize(static_cast<Eigen::Index>(columns.size()));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const double value = table_.number(row, columns[i]);
      const bool turns = m_.by_joints() ? m_.joint_rotates[i] : i >= 3;
      if (turns) table_.angle(row, columns[i], m_.by_joints() ? 1 : pi / 180);
      if (m_.by_joints())
        group.joints(at) = m_.joint_rotates[i] ? value : value / 1e3;
      else
        group.pose_mm_deg(at) = value;
    }
    return group;
  }

  void check_same_command(std::size_t row, std::size_t first) const {
    for (const std::size_t column : columns_.command) {
      if (table_.text(row, column) == table_.text(first, column)) continue;
      if (table_.number(row, column) != table_.number(first, column))
        table_.refuse(row, column,
                      fmt::format("{} here and {} in line {}, both of pose '{}': one label is one approach of one "
                                  "commanded pose, use another label",
                                  excerpt(table_.text(row, column)), excerpt(table_.text(first, column)),
                                  table_.line(first), excerpt(table_.text(row, columns_.pose))));
    }
  }

  /// The cell's number; empty where there is neither column nor text.
  std::optional<double> number(std::size_t row, std::optional<std::size_t> column) const {
    if (!column || table_.text(row, *column).empty()) return std::nullopt;
    return table_.number(row, *column);
  }

  std::optional<double> sigma(std::size_t row, std::optional<std::size_t> column, double per_SI) const {
    std::optional<double> value = number(row, column);
    if (!value) return value;
    *value /= per_SI;
    if (!(*value > 0))
      table_.refuse(row, *column,
                    fmt::format("{} is not positive: no reading is exact, leave the cell empty where the standard "
                                "deviation is not known",
                                excerpt(table_.text(row, *column))));
    return value;
  }

  double sequence(std::size_t row, std::size_t column) {
    if (table_.text(row, column).empty())
      table_.refuse(row, column, "the cell is empty: number all readings or remove the column");
    const double value = table_.number(row, column);
    const auto [same, is_new] = row_of_sequence_.emplace(value, row);
    if (!is_new)
      table_.refuse(row, column,
                    fmt::format("{} stands in line {} too: two readings are not taken at once, number them in the "
                                "order they were taken",
                                excerpt(table_.text(row, column)), table_.line(same->second)));
    return value;
  }

  const CsvTable& table_;
  const MeasurementColumns columns_;
  Measurements m_;
  std::unordered_map<std::string_view, std::size_t> group_of_;
  std::unordered_map<double, std::size_t> row_of_sequence_;
};

}  // namespace

Measurements parse_measurements(std::string text, const std::string& origin) {
  const CsvTable table = parse_csv(std::move(text), origin);
  return Reader(table, origin, false).read();
}

Measurements read_measurements(const std::filesystem::path& path) {
  return parse_measurements(read_text(path), path.string());
}

Measurements read_plan(const std::filesystem::path& path) {
  const CsvTable table = parse_csv(read_text(path), path.string());
  Measurements m = Reader(table, path.string(), true).read();
  for (Reading& r : m.readings) r.displacement = {};
  return m;
}

Measurements one_pose(const Measurements& m, std::size_t pose) {
  Measurements out{m.origin, m.joint_rotates, m.note_columns, m.temperature_recorded, {m.poses.at(pose)}, {}};
  for (std::size_t& i : out.poses.front().readings) {
    out.readings.push_back(m.readings[i]);
    out.readings.back().pose = 0;
    i = out.readings.size() - 1;
  }
  return out;
}

std::vector<std::size_t> in_sequence(const Measurements& m, const std::string& purpose) {
  std::vector<std::size_t> order(m.readings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!std::all_of(m.readings.begin(), m.readings.end(), [](const Reading& r) { return r.sequence.has_value(); }))
    throw InputError(
        fmt::format("{}:1: column 'sequence' is missing: {} needs the order in which the readings were "
                    "taken",
                    m.origin, purpose));
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return m.readings[a].sequence < m.readings[b].sequence; });
  return order;
}

}  // namespace deflect
