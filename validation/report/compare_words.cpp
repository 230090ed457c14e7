#include "validation/report/compare_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "validation/report/text.h"

namespace deflect::report {
namespace {

std::string file_of(const compare::Comparison& c) { return c.data.substr(c.data.find_last_of('/') + 1); }

std::string range(double low, double high) {
  return std::abs(high - low) < 1e-9 * std::max(std::abs(low), std::abs(high)) + 1e-12
             ? fmt::format("{:.4g}", low + 0.0)
             : fmt::format("{:.4g} … {:.4g}", low + 0.0, high + 0.0);
}

/// "fx −50 … 50, fz −20 … 50 N, mx 0 … 100 Nmm".
std::string loads_text(const measurement::Measurements& data) {
  constexpr const char* names[] = {"fx", "fy", "fz", "mx", "my", "mz"};
  std::string out;
  for (int kind = 0; kind < 2; ++kind) {
    std::string list;
    for (int k = 3 * kind; k < 3 * kind + 3; ++k) {
      double low = 0, high = 0;
      for (const measurement::Reading& r : data.readings)
        low = std::min(low, r.load(k)), high = std::max(high, r.load(k));
      const double unit = kind == 0 ? 1 : 1e3;
      if (low < high)
        list += fmt::format("{}{} {}", list.empty() ? "" : ", ", names[k], range(unit * low, unit * high));
    }
    if (!list.empty()) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", list, kind == 0 ? "N" : "Nmm");
  }
  return out.empty() ? "no load" : "loads on the tool point " + out;
}

std::string short_list(std::vector<std::string> names, std::size_t most) {
  const std::size_t more = names.size() > most ? names.size() - most : 0;
  names.resize(names.size() - more);
  return fmt::format("{}{}", fmt::join(names, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
}

}  // namespace

ErrorUnit error_unit(const compare::Comparison& c) {
  ErrorUnit out;
  out.quantity = compare::quantity_of_errors(c.study.values);
  const measurement::QuantityRow& row = measurement::row_of(out.quantity);
  out.micro = row.fine, out.milli = row.coarse, out.column = row.fine_column;
  out.fine = row.fine_per_SI, out.coarse = row.coarse_per_SI;
  if (out.quantity != measurement::Quantity::angle || !c.study.standing->has_tool_point()) return out;
  out.rotations = true;
  out.load = "Nm";
  for (int k = 0; k < 3; ++k) {
    constexpr const char *turns[] = {"Δθx", "Δθy", "Δθz"}, *moments[] = {"mx", "my", "mz"};
    out.components[k] = turns[k], out.loads[k] = moments[k];
  }
  return out;
}

std::vector<ReadingCells> cells_of(const compare::Comparison& c) {
  const Eigen::Index first = error_unit(c).rotations ? 3 : 0;
  std::vector<ReadingCells> out(c.readings);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const measurement::Reading& r = c.study.data->readings[i];
    out[i].measured = out[i].residual = Vector3::Constant(NAN);
    out[i].predicted = c.study.predicted[i].segment<3>(first);
    out[i].load = r.load.segment<3>(first);
    out[i].pure = (out[i].load.array() != 0).count() <= 1 && r.load.segment<3>(3 - first).isZero(0);
    out[i].set_aside = std::find(c.set_aside.begin(), c.set_aside.end(), r.line) != c.set_aside.end();
  }
  for (std::size_t i = 0; i < c.study.values.size(); ++i) {
    const measurement::MeasuredValue& v = c.study.values[i];
    const Eigen::Index k = as_index(v.channel) - first;
    if (!v.of_tool_point() || k < 0 || k >= 3) continue;
    out[v.reading].measured(k) = v.value;
    out[v.reading].residual(k) = c.residual(as_index(i));
  }
  return out;
}

std::string poses_words(const compare::Comparison& c) {
  return c.study.standing->has_tool_point() || c.poses > 1 ? " at " + counted(c.poses, "pose") : "";
}

std::string subjects(const compare::Comparison& c) {
  return fmt::format("{} against {}", clip(c.device, 40), clip(file_of(c), 40));
}

std::string data_sentence(const compare::Comparison& c) {
  if (!c.study.standing->has_tool_point()) {
    std::vector<std::string> loads, sensors;
    for (const measurement::LoadChannel& each : measurement::load_channels(*c.study.data)) loads.push_back(each.name);
    for (const measurement::SensorChannel& each : c.study.data->instruments.sensors) sensors.push_back(each.name);
    return fmt::format("Frame {}, measurements {}: {} of {} under {}.", c.device, file_of(c),
                       counted(c.readings, "reading"), short_list(sensors, 8), short_list(loads, 6));
  }
  Vector3 low = Vector3::Constant(INFINITY), high = -low;
  for (std::size_t p = 0; p < c.poses; ++p) {
    const Vector3 at = 1e3 * c.study.standing->tool(p).p_W;
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  return fmt::format("Device {}, measurements {}: {} at {} (tool point x {}, y {}, z {} mm), {}.", c.device, file_of(c),
                     counted(c.readings, "reading"), counted(c.poses, "pose"), range(low.x(), high.x()),
                     range(low.y(), high.y()), range(low.z(), high.z()), loads_text(*c.study.data));
}

std::string noise_sentence(const compare::Comparison& c) {
  const ErrorUnit unit = error_unit(c);
  return fmt::format(
      "Standard deviation of a reading {:.3g} {}{}; noise and tolerances of manufacture together give "
      "{:.3g} {} rms.",
      unit.fine * c.sigma_u, unit.micro, c.sigma_from_residuals ? " (estimated from the residuals)" : "",
      unit.fine * c.noise_and_tolerances, unit.micro);
}

std::string axes_sentence(const compare::Comparison& c) {
  if (!c.study.standing->has_tool_point())
    return "Readings against the unloaded frame; residual = measured − predicted.";
  return error_unit(c).rotations
             ? "Rotations of the tool frame against the unloaded machine, about base axes; residual = measured − "
               "predicted."
             : "Displacements of the tool point against the unloaded machine, base axes; residual = measured − "
               "predicted.";
}

}  // namespace deflect::report
