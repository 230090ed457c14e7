#include "validation/compare/errors_by_group.h"

#include "msa/base/index.h"
#include "validation/compare/comparison.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <map>
#include <numeric>

namespace deflect::compare {
namespace {

/// Whether a measured number belongs to the group.
using Belongs = std::function<bool(const measurement::MeasuredValue&)>;

Errors errors_of(const Comparison& c, const std::string& group, bool rotations, const std::vector<std::size_t>& values,
                 const Belongs& belongs) {
  Errors e;
  e.group = group;
  double squares = 0, measured = 0, n = 0;
  Vector3 sum = Vector3::Zero(), count = Vector3::Zero();
  std::size_t last = c.readings;
  for (const std::size_t i : values) {
    const measurement::MeasuredValue& v = c.study.values[i];
    if (v.rotation != rotations || !belongs(v)) continue;
    const double r = c.residual(as_index(i));
    squares += r * r;
    measured += v.value * v.value;
    n += 1;
    if (v.of_tool_point()) {
      sum(as_index(v.channel % 3)) += r;
      count(as_index(v.channel % 3)) += 1;
    }
    if (v.reading != last) ++e.readings;
    last = v.reading;
    if (std::abs(r) > e.worst) e.worst = std::abs(r), e.worst_line = c.study.data->readings[v.reading].line;
  }
  if (n == 0) return e;
  e.rmse = std::sqrt(squares / n);
  e.measured = std::sqrt(measured / n);
  e.bias = sum.cwiseQuotient(count.cwiseMax(1));
  for (std::size_t k = 0; k < 3; ++k) e.measured_along[k] = count(as_index(k)) > 0;
  return e;
}

/// "fx > 0", "mz < 0", "handle.fx > 0" where one component is all of the load, "oblique", "no load".
std::string direction_of(const measurement::Reading& r, const measurement::Measurements& data) {
  constexpr const char* names[] = {"fx", "fy", "fz", "mx", "my", "mz"};
  const std::vector<std::string>& points = data.instruments.load_points;
  std::vector<std::pair<std::string, Vector6>> loads = {{"", points.empty() ? r.load : r.at_tool}};
  for (std::size_t p = 0; p < points.size(); ++p) loads.emplace_back(points[p] + ".", r.at_points[p]);
  std::erase_if(loads, [](const auto& load) { return load.second.isZero(0); });
  if (loads.empty()) return "no load";
  const auto& [where, F] = loads.front();
  Eigen::Index largest = 0;
  Vector6 weighed = F;
  weighed.tail<3>() *= 10;  // moments against forces on 100 mm
  weighed.cwiseAbs().maxCoeff(&largest);
  if (loads.size() > 1 || weighed.norm() > 1.001 * std::abs(weighed(largest))) return "oblique";
  return fmt::format("{}{} {} 0", where, names[largest], F(largest) > 0 ? ">" : "<");
}

}  // namespace

bool rotations_alone(const std::vector<measurement::MeasuredValue>& values) {
  return std::all_of(values.begin(), values.end(), [](const measurement::MeasuredValue& v) { return v.rotation; });
}

double rms_of_kept(const std::vector<measurement::MeasuredValue>& values, const VectorX& x,
                   const std::vector<bool>& set_aside) {
  std::vector<measurement::MeasuredValue> kept;
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!set_aside[values[i].reading]) kept.push_back(values[i]), rows.push_back(as_index(i));
  return rms_of_errors(kept, x(rows));
}

double rms_of_errors(const std::vector<measurement::MeasuredValue>& values, const VectorX& x) {
  const bool rotations = rotations_alone(values);
  double squares = 0, n = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i].rotation == rotations) {
      squares += x(as_index(i)) * x(as_index(i));
      n += 1;
    }
  return n > 0 ? std::sqrt(squares / n) : 0;
}

void add_errors(Comparison& c) {
  for (auto* list : {&c.by_axis, &c.by_pose, &c.by_direction, &c.by_magnitude, &c.by_heading}) list->clear();
  const measurement::Measurements& data = *c.study.data;
  const bool rotations = rotations_alone(c.study.values);
  std::vector<std::size_t> all(c.study.values.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const auto group = [&](const std::string& name, const Belongs& belongs) {
    return errors_of(c, name, rotations, all, belongs);
  };
  c.all = group("", [](const measurement::MeasuredValue&) { return true; });
  for (std::size_t k = 0; k < 3; ++k) {
    const Errors e = group(std::string(1, "xyz"[k]), [&](const measurement::MeasuredValue& v) {
      return v.of_tool_point() && v.channel % 3 == k;
    });
    if (e.readings > 0) c.by_axis.push_back(e);
  }
  for (std::size_t k = 6; k < 6 + data.instruments.sensors.size(); ++k) {
    const Errors e =
        group(measurement::channel_name(data, k), [&](const measurement::MeasuredValue& v) { return v.channel == k; });
    if (e.readings > 0) c.by_axis.push_back(e);
  }
  const auto every = [](const measurement::MeasuredValue&) { return true; };
  std::vector<std::vector<std::size_t>> of_pose(data.poses.size());
  for (const std::size_t i : all) of_pose[data.readings[c.study.values[i].reading].pose].push_back(i);
  for (std::size_t p = 0; p < data.poses.size(); ++p)
    c.by_pose.push_back(errors_of(c, "pose " + data.poses[p].label, rotations, of_pose[p], every));
  double most = 0;
  std::map<std::string, std::vector<std::size_t>> directions;
  std::vector<std::vector<std::size_t>*> direction;
  for (const measurement::Reading& r : data.readings) {
    direction.push_back(&directions[direction_of(r, data)]);
    most = std::max(most, r.load.head<3>().norm());
  }
  for (const std::size_t i : all) direction[c.study.values[i].reading]->push_back(i);
  for (const auto& [name, values] : directions) c.by_direction.push_back(errors_of(c, name, rotations, values, every));
  if (most > 0)
    for (int third = 0; third < 3; ++third) {
      const double low = most * third / 3, high = most * (third + 1) / 3;
      const auto within = [&, third](const measurement::MeasuredValue& v) {
        const double F = data.readings[v.reading].load.head<3>().norm();
        return F > low * (1 + 1e-9) && F <= high * (1 + 1e-9) && (third > 0 || F > 0);
      };
      const Errors e = group(fmt::format("{:.3g} … {:.3g} N", low, high), within);
      if (e.readings > 0) c.by_magnitude.push_back(e);
    }
  if (!c.study.sequence) return;
  // Whether the largest site force had risen or fallen in size.
  const auto heading = [&](const measurement::MeasuredValue& v) {
    const VectorX &f = c.study.force[v.reading], &h = c.study.heading[v.reading];
    if (f.size() == 0) return 0.0;
    Eigen::Index k = 0;
    f.cwiseAbs().maxCoeff(&k);
    return f(k) * h(k);
  };
  for (const auto& [name, sign] : {std::pair<const char*, double>{"loading", 1}, {"unloading", -1}}) {
    const Errors e = group(name, [&, s = sign](const measurement::MeasuredValue& v) { return heading(v) * s > 0; });
    if (e.readings > 0) c.by_heading.push_back(e);
  }
}

}  // namespace deflect::compare
