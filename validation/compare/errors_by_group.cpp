#include "validation/compare/errors_by_group.h"

#include "msa/base/index.h"
#include "validation/compare/comparison.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <optional>

namespace deflect::compare {
namespace {

/// Whether a measured number belongs to the group.
using Belongs = std::function<bool(const measurement::MeasuredValue&)>;

Errors errors_of(const Comparison& c, const std::string& group, measurement::Quantity quantity,
                 const std::vector<std::size_t>& values, const Belongs& belongs) {
  Errors e;
  e.group = group;
  e.quantity = quantity;
  double squares = 0, measured = 0, n = 0;
  Vector3 sum = Vector3::Zero(), count = Vector3::Zero();
  std::size_t last = c.readings;
  for (const std::size_t i : values) {
    const measurement::MeasuredValue& v = c.study.values[i];
    if (v.quantity != quantity || !belongs(v)) continue;
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

/// Of a frame: "load.snow > 0", "node.B.fz < 0".
std::string direction_of(const std::vector<measurement::LoadChannel>& channels, const VectorX& load) {
  std::string out;
  for (std::size_t k = 0; k < channels.size(); ++k) {
    if (load(as_index(k)) == 0) continue;
    if (!out.empty()) return "several loads";
    out = fmt::format("{} {} 0", channels[k].name, load(as_index(k)) > 0 ? ">" : "<");
  }
  return out.empty() ? "no load" : out;
}

/// Of each reading: a machine's force, N; of a frame the largest of its loads, each as a share of its own largest.
VectorX sizes_of_loads(const ResidualStudy& s) {
  if (!s.data->instruments.stationary) return s.loads.topRows(3).colwise().norm();
  const VectorX most = s.loads.cwiseAbs().rowwise().maxCoeff().cwiseMax(1e-300);
  VectorX out = VectorX::Zero(s.loads.cols());
  for (Eigen::Index i = 0; i < out.size() && most.size() > 0; ++i)
    out(i) = s.loads.col(i).cwiseAbs().cwiseQuotient(most).maxCoeff();
  return out;
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

/// By reading: by how much its load is larger than that of the reading before, of one that is read again as much as of
/// its first reading; of a subject without sites.
VectorX size_changes(const ResidualStudy& s, const VectorX& size) {
  VectorX out = VectorX::Zero(size.size());
  if (!s.data->instruments.stationary) return out;
  std::optional<Eigen::Index> last;
  for (const std::size_t reading : measurement::in_sequence(*s.data, "loading and unloading")) {
    const Eigen::Index i = as_index(reading);
    const bool again = last && s.loads.col(i) == s.loads.col(*last);
    out(i) = again ? out(*last) : size(i) - (last ? size(*last) : 0);
    last = i;
  }
  return out;
}

}  // namespace

measurement::Quantity quantity_of_errors(const std::vector<measurement::MeasuredValue>& values) {
  measurement::Quantity first = values.empty() ? measurement::Quantity::length : values.front().quantity;
  for (const measurement::MeasuredValue& v : values) first = std::min(first, v.quantity);
  return first;
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
  const measurement::Quantity quantity = quantity_of_errors(values);
  double squares = 0, n = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i].quantity == quantity) {
      squares += x(as_index(i)) * x(as_index(i));
      n += 1;
    }
  return n > 0 ? std::sqrt(squares / n) : 0;
}

namespace {

/// In thirds of the largest load.
void add_by_magnitude(Comparison& c, const VectorX& size, const std::vector<std::size_t>& all) {
  const double most = size.maxCoeff();
  if (most > 0)
    for (int third = 0; third < 3; ++third) {
      const double low = most * third / 3, high = most * (third + 1) / 3;
      const auto within = [&, third](const measurement::MeasuredValue& v) {
        const double F = size(as_index(v.reading));
        return F > low * (1 + 1e-9) && F <= high * (1 + 1e-9) && (third > 0 || F > 0);
      };
      const Errors e = errors_of(c,
                                 c.study.data->instruments.stationary
                                     ? fmt::format("{:.0f} … {:.0f} % of the largest load", 100 * low, 100 * high)
                                     : fmt::format("{:.3g} … {:.3g} N", low, high),
                                 quantity_of_errors(c.study.values), all, within);
      if (e.readings > 0) c.by_magnitude.push_back(e);
    }
}

}  // namespace

void add_errors(Comparison& c) {
  for (auto* list : {&c.by_axis, &c.by_pose, &c.by_direction, &c.by_magnitude, &c.by_heading}) list->clear();
  const measurement::Measurements& data = *c.study.data;
  const measurement::Quantity quantity = quantity_of_errors(c.study.values);
  std::vector<std::size_t> all(c.study.values.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const auto group = [&](const std::string& name, const Belongs& belongs) {
    return errors_of(c, name, quantity, all, belongs);
  };
  c.all = group("", [](const measurement::MeasuredValue&) { return true; });
  for (std::size_t k = 0; k < 3; ++k) {
    const Errors e = group(std::string(1, "xyz"[k]), [&](const measurement::MeasuredValue& v) {
      return v.of_tool_point() && v.channel % 3 == k;
    });
    if (e.readings > 0) c.by_axis.push_back(e);
  }
  for (std::size_t k = 6; k < 6 + data.instruments.sensors.size(); ++k) {
    const Errors e = errors_of(c, measurement::channel_name(data, k), data.instruments.sensors[k - 6].quantity, all,
                               [&](const measurement::MeasuredValue& v) { return v.channel == k; });
    if (e.readings > 0) c.by_axis.push_back(e);
  }
  const auto every = [](const measurement::MeasuredValue&) { return true; };
  std::vector<std::vector<std::size_t>> of_pose(data.poses.size());
  for (const std::size_t i : all) of_pose[data.readings[c.study.values[i].reading].pose].push_back(i);
  for (std::size_t p = 0; p < data.poses.size(); ++p)
    c.by_pose.push_back(errors_of(c, "pose " + data.poses[p].label, quantity, of_pose[p], every));
  std::map<std::string, std::vector<std::size_t>> directions;
  std::vector<std::vector<std::size_t>*> direction;
  const std::vector<measurement::LoadChannel> channels = measurement::load_channels(data);
  for (std::size_t i = 0; i < data.readings.size(); ++i)
    direction.push_back(&directions[data.instruments.stationary ? direction_of(channels, c.study.loads.col(as_index(i)))
                                                                : direction_of(data.readings[i], data)]);
  for (const std::size_t i : all) direction[c.study.values[i].reading]->push_back(i);
  for (const auto& [name, values] : directions) c.by_direction.push_back(errors_of(c, name, quantity, values, every));
  const VectorX size = sizes_of_loads(c.study);
  add_by_magnitude(c, size, all);
  if (!c.study.sequence) return;
  const VectorX risen = size_changes(c.study, size);
  // Whether the largest site force, or without sites the load, had risen or fallen in size.
  const auto heading = [&](const measurement::MeasuredValue& v) {
    const VectorX &f = c.study.force[v.reading], &h = c.study.heading[v.reading];
    if (f.size() == 0) return risen(as_index(v.reading));
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
