#include "validation/studies/points_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "msa/base/index.h"
#include "validation/measurement/column_names.h"
#include "validation/measurement/csv.h"

namespace deflect::studies {
namespace {

void check_columns(const measurement::CsvTable& table) {
  std::vector<std::string> known = {"pose"};
  known.insert(known.end(), measurement::pose_columns.begin(), measurement::pose_columns.end());
  for (const std::string& name : table.header())
    if (!measurement::is_note(name) && std::find(known.begin(), known.end(), name) == known.end())
      table.refuse_header(measurement::unknown_column(name, known));
  for (std::size_t i = 0; i < 3; ++i)
    if (!table.column(measurement::pose_columns[i]))
      table.refuse_header(
          fmt::format("column '{}' is missing: x_mm, y_mm and z_mm are needed", measurement::pose_columns[i]));
}

}  // namespace

std::vector<ValidationPoint> read_points(const std::filesystem::path& path) {
  const measurement::CsvTable table = measurement::read_csv(path.string());
  check_columns(table);
  const std::optional<std::size_t> label = table.column("pose");
  std::map<std::string, std::size_t> line_of;
  std::vector<ValidationPoint> points(table.rows());
  for (std::size_t row = 0; row < points.size(); ++row) {
    ValidationPoint& point = points[row];
    point.label = label ? std::string(table.text(row, *label)) : std::to_string(row);
    if (point.label.empty()) table.refuse(row, *label, "the label is empty");
    const auto [same, is_new] = line_of.emplace(point.label, table.line(row));
    if (!is_new)
      table.refuse(row, *label, fmt::format("'{}' is already the label of line {}", point.label, same->second));
    for (std::size_t i = 0; i < measurement::pose_columns.size(); ++i)
      if (const auto column = table.column(measurement::pose_columns[i])) {
        if (i >= 3) table.angle(row, *column, pi / 180);
        point.pose_mm_deg[as_index(i)] = table.number(row, *column);
      }
  }
  return points;
}

}  // namespace deflect::studies
