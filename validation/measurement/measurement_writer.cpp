#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/index.h"
#include "validation/measurement/measurement_columns.h"
#include "validation/measurement/measurements.h"
#include "validation/measurement/number_limits.h"

namespace deflect::measurement {
namespace {

/// The shortest number whose double, divided by `per_SI`, is `value`.
std::string number_text(double value, double per_SI = 1) {
  if (per_SI == 1) return fmt::format("{}", value);
  const double scaled = value * per_SI;
  for (const int digits : {15, 16}) {
    const std::string text = fmt::format("{:.{}g}", scaled, digits);
    double rounded = 0;
    std::from_chars(text.data(), text.data() + text.size(), rounded);
    if (rounded / per_SI == value) return fmt::format("{}", rounded);
  }
  for (const double neighbour : {std::nextafter(scaled, 0), std::nextafter(scaled, 2 * scaled)})
    if (neighbour / per_SI == value) return fmt::format("{}", neighbour);
  return fmt::format("{}", scaled);
}

std::string number_text(const std::optional<double>& value, double per_SI = 1) {
  return value ? number_text(*value, per_SI) : "";
}

std::string quoted_where_needed(const std::string& text) {
  const bool padded = !text.empty() && (std::string_view(" \t").find(text.front()) != std::string_view::npos ||
                                        std::string_view(" \t").find(text.back()) != std::string_view::npos);
  if (!padded && text.find_first_of(",;\"\r\n") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

struct Column {
  std::string name;
  std::function<std::string(const Reading&)> cell;
};

void add_loads(std::vector<Column>& columns, const Measurements& m) {
  const bool elsewhere = !m.instruments.load_points.empty();
  const auto add = [&](const std::string& name, Eigen::Index i, bool always, const auto& of) {
    if (always || std::any_of(m.readings.begin(), m.readings.end(), [&](const Reading& r) { return of(r)(i) != 0; }))
      columns.push_back({name, [i, of](const Reading& r) { return number_text(of(r)(i), i < 3 ? 1 : 1e3); }});
  };
  for (std::size_t k = 0; k < m.instruments.load_cases.size(); ++k)
    columns.push_back(
        {"load." + m.instruments.load_cases[k], [k](const Reading& r) { return number_text(r.factors[k]); }});
  for (Eigen::Index i = 0; i < 6 && !m.instruments.stationary; ++i)
    add(nth(load_columns, i), i, i < 3,
        [elsewhere](const Reading& r) -> const Vector6& { return elsewhere ? r.at_tool : r.load; });
  for (std::size_t p = 0; p < m.instruments.load_points.size(); ++p)
    for (Eigen::Index i = 0; i < 6; ++i)
      add(load_column(m.instruments.load_points[p], as_size(i)), i, i == 0 && !m.instruments.stationary,
          [p](const Reading& r) -> const Vector6& { return r.at_points[p]; });
}

/// Those that say something: the reader's defaults stand for the others.
std::vector<Column> columns_of(const Measurements& m, const std::array<bool, 6>& to_fill_in) {
  const auto any = [&](const auto& has) { return std::any_of(m.readings.begin(), m.readings.end(), has); };
  std::vector<Column> columns;
  if (!m.instruments.stationary || m.poses.size() > 1)
    columns.push_back({"pose", [&m](const Reading& r) { return quoted_where_needed(m.poses[r.pose].label); }});
  if (any([](const Reading& r) { return r.sequence.has_value(); }))
    columns.push_back({"sequence", [](const Reading& r) { return number_text(r.sequence); }});
  const std::size_t commands = m.instruments.stationary ? 0 : m.by_joints() ? m.joint_rotates.size() : 6;
  for (std::size_t i = 0; i < commands; ++i) {
    const auto at = as_index(i);
    if (m.by_joints()) {
      const double per_SI = m.joint_rotates[i] ? 1 : 1e3;
      columns.push_back({joint_column(i, m.joint_rotates[i]), [&m, at, per_SI](const Reading& r) {
                           return number_text(m.poses[r.pose].joints(at), per_SI);
                         }});
    } else {
      columns.push_back(
          {pose_columns[i], [&m, at](const Reading& r) { return number_text(m.poses[r.pose].pose_mm_deg(at)); }});
    }
  }
  add_loads(columns, m);
  if (m.temperature_recorded || any([](const Reading& r) { return r.temperature_C != 20; }))
    columns.push_back({"temperature_C", [](const Reading& r) { return number_text(r.temperature_C); }});
  const auto& sensors = m.instruments.sensors;
  const bool told = std::find(to_fill_in.begin(), to_fill_in.end(), true) != to_fill_in.end();
  for (std::size_t i = 0; i < 6; ++i)
    if ((i < 3 && sensors.empty() && !told) || to_fill_in[i] ||
        any([i](const Reading& r) { return r.displacement[i].has_value(); }))
      columns.push_back(
          {displacement_columns[i], [i](const Reading& r) { return number_text(r.displacement[i], i < 3 ? 1e3 : 1); }});
  for (std::size_t k = 0; k < sensors.size(); ++k)
    columns.push_back({sensor_column(sensors[k]), [k, per_SI = row_of(sensors[k].quantity).per_SI](const Reading& r) {
                         return number_text(r.sensors[k], per_SI);
                       }});
  if (any([](const Reading& r) { return r.sigma_u.has_value(); }))
    columns.push_back({"sigma_u_mm", [](const Reading& r) { return number_text(r.sigma_u, 1e3); }});
  if (any([](const Reading& r) { return r.sigma_th.has_value(); }))
    columns.push_back({"sigma_th_rad", [](const Reading& r) { return number_text(r.sigma_th); }});
  for (std::size_t i = 0; i < m.note_columns.size(); ++i)
    columns.push_back(
        {quoted_where_needed(m.note_columns[i]), [i](const Reading& r) { return quoted_where_needed(r.notes[i]); }});
  return columns;
}

/// What the reader would refuse is not written.
void require_readable(const std::filesystem::path& path, const Measurements& m) {
  const auto require = [&](const std::optional<double>& measured, double per_SI, const std::string& column) {
    if (measured && !(std::abs(*measured * per_SI) <= largest_measured))
      throw InputError(fmt::format("{}: {} in column '{}' is out of all proportion: numbers up to {:g} are read",
                                   path.string(), number_text(measured, per_SI), column, largest_measured));
  };
  for (const Reading& r : m.readings) {
    for (std::size_t i = 0; i < 6; ++i) require(r.displacement[i], i < 3 ? 1e3 : 1, displacement_columns[i]);
    for (std::size_t k = 0; k < r.sensors.size(); ++k) {
      const SensorChannel& sensor = m.instruments.sensors[k];
      require(r.sensors[k], row_of(sensor.quantity).per_SI, sensor_column(sensor));
    }
  }
}

}  // namespace

std::string measurements_text(const Measurements& m, const std::array<bool, 6>& to_fill_in) {
  const std::vector<Column> columns = columns_of(m, to_fill_in);
  std::string text;
  for (const Column& column : columns) text += (text.empty() ? "" : ",") + column.name;
  text += '\n';
  for (const Reading& reading : m.readings)
    for (const Column& column : columns) {
      text += column.cell(reading);
      text += &column == &columns.back() ? '\n' : ',';
    }
  return text;
}

void write_measurements(const std::filesystem::path& path, const Measurements& m,
                        const std::array<bool, 6>& to_fill_in) {
  require_readable(path, m);
  write_text(path, measurements_text(m, to_fill_in));
}

}  // namespace deflect::measurement
