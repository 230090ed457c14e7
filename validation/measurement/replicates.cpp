#include "validation/measurement/replicates.h"
#include "msa/base/index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace deflect::measurement {
namespace {

using Numbers = std::vector<double>;

/// The loads of each reading, rounded.
std::vector<Numbers> to_1e9(const MatrixX& loads) {
  std::vector<Numbers> out;
  for (const auto& load : loads.colwise()) {
    out.emplace_back();
    for (const double each : load) out.back().push_back(std::round(each * 1e9));
  }
  return out;
}

/// Signs of the changes by which each reading's load was reached, of one that is read again those of its first reading;
/// zero without a sequence.
std::vector<Numbers> directions(const Measurements& m, const std::vector<Numbers>& loads) {
  std::vector<Numbers> signs(m.readings.size());
  if (m.readings.empty() || !m.readings.front().sequence) return signs;
  const Numbers none(loads.front().size());
  const Numbers* before = &none;
  std::optional<std::size_t> last;
  for (const std::size_t i : in_sequence(m, "the direction of loading")) {
    const bool another_pose = !last || m.readings[i].pose != m.readings[*last].pose;
    const std::optional<std::size_t> earlier = another_pose ? std::nullopt : last;
    last = i;
    const Numbers& load = loads[i];
    if (earlier && load == loads[*earlier]) {
      signs[i] = signs[*earlier];
      continue;
    }
    if (another_pose) before = &none;
    for (std::size_t k = 0; k < load.size(); ++k)
      signs[i].push_back(load[k] > (*before)[k] ? 1 : load[k] < (*before)[k] ? -1 : 0);
    before = &load;
  }
  return signs;
}

class Pool {
 public:
  void add_group(std::vector<double> values) {
    if (values.size() < 2) return;
    // From the first value, lest the rounding of the mean make equal numbers scatter.
    const double first = values.front();
    double mean = 0;
    for (double& v : values) mean += (v -= first) / static_cast<double>(values.size());
    for (const double v : values) sum_ += (v - mean) * (v - mean);
    degrees_of_freedom_ += values.size() - 1;
  }

  std::optional<NoiseEstimate> estimate() const {
    const double sigma = std::sqrt(sum_ / static_cast<double>(degrees_of_freedom_));
    if (!(sigma > 0) || !std::isfinite(sigma)) return std::nullopt;
    return NoiseEstimate{sigma, degrees_of_freedom_};
  }

 private:
  double sum_ = 0;
  std::size_t degrees_of_freedom_ = 0;
};

}  // namespace

std::vector<std::vector<std::size_t>> replicates(const Measurements& m, Reached reached) {
  const std::vector<Numbers> loads = to_1e9(loads_of(m));
  const std::vector<Numbers> direction =
      reached == Reached::in_same_direction ? directions(m, loads) : std::vector<Numbers>(m.readings.size());
  std::vector<std::vector<std::size_t>> groups;
  for (const PoseGroup& pose : m.poses) {
    std::map<std::pair<Numbers, Numbers>, std::vector<std::size_t>> alike;
    for (const std::size_t i : pose.readings) alike[{loads[i], direction[i]}].push_back(i);
    for (auto& [key, group] : alike)
      if (group.size() > 1) groups.push_back(std::move(group));
  }
  std::sort(groups.begin(), groups.end());
  return groups;
}

PureError pure_error(const Measurements& m, Reached reached) {
  Pool u, th;
  for (const std::vector<std::size_t>& group : replicates(m, reached))
    for (std::size_t component = 0; component < 6; ++component) {
      std::vector<double> values;
      for (const std::size_t i : group)
        if (const auto& value = m.readings[i].displacement[component]) values.push_back(*value);
      (component < 3 ? u : th).add_group(values);
    }
  return {u.estimate(), th.estimate()};
}

namespace {

/// Of each sensor by itself: instruments differ.
std::vector<std::optional<NoiseEstimate>> pure_error_of_sensors(const Measurements& m) {
  std::vector<Pool> pools(m.instruments.sensors.size());
  if (pools.empty()) return {};
  for (const std::vector<std::size_t>& group : replicates(m))
    for (std::size_t k = 0; k < pools.size(); ++k) {
      std::vector<double> values;
      for (const std::size_t i : group)
        if (const auto& value = m.readings[i].sensors[k]) values.push_back(*value);
      pools[k].add_group(std::move(values));
    }
  std::vector<std::optional<NoiseEstimate>> out;
  for (const Pool& pool : pools) out.push_back(pool.estimate());
  return out;
}

std::optional<double> sigma_of(const std::optional<NoiseEstimate>& noise) {
  return noise ? std::optional(noise->sigma) : std::nullopt;
}

}  // namespace

std::optional<NoiseEstimate> pure_error_of(const Measurements& m, Quantity quantity) {
  Pool pool;
  for (const std::vector<std::size_t>& group : replicates(m)) {
    const auto add = [&](const auto& value_of) {
      std::vector<double> values;
      for (const std::size_t i : group)
        if (const auto& value = value_of(m.readings[i])) values.push_back(*value);
      pool.add_group(std::move(values));
    };
    for (std::size_t k = 0; k < 6; ++k)
      if (displacement_quantity(k) == quantity) add([k](const Reading& r) { return r.displacement[k]; });
    for (std::size_t k = 0; k < m.instruments.sensors.size(); ++k)
      if (m.instruments.sensors[k].quantity == quantity) add([k](const Reading& r) { return r.sensors[k]; });
  }
  return pool.estimate();
}

MeasuredValue tool_point_value(std::size_t reading, std::size_t component, double value, std::optional<double> sigma) {
  return {
      reading, component, value, sigma, displacement_quantity(component), false, Vector6::Unit(as_index(component))};
}

std::vector<MeasuredValue> measured_values(const Measurements& m, const SensorForm& form) {
  const PureError estimated = pure_error(m);
  const std::vector<std::optional<NoiseEstimate>> of_sensors = pure_error_of_sensors(m);
  std::vector<MeasuredValue> values;
  for (std::size_t i = 0; i < m.readings.size(); ++i) {
    const Reading& r = m.readings[i];
    for (std::size_t k = 0; k < 6; ++k) {
      if (!r.displacement[k]) continue;
      const std::optional<double>& given = k < 3 ? r.sigma_u : r.sigma_th;
      values.push_back(
          tool_point_value(i, k, *r.displacement[k], given ? given : sigma_of(k < 3 ? estimated.u : estimated.th)));
      values.back().by_replicates = !given && values.back().sigma;
    }
    for (std::size_t k = 0; k < r.sensors.size(); ++k) {
      if (!r.sensors[k]) continue;
      const SensorChannel& sensor = m.instruments.sensors[k];
      MeasuredValue v{i, 6 + k, *r.sensors[k], sensor.sigma, sensor.quantity};
      v.by_replicates = !v.sigma && of_sensors[k];
      if (v.by_replicates) v.sigma = of_sensors[k]->sigma;
      if (!v.sigma && sensor.quantity == Quantity::length) v.sigma = r.sigma_u;
      if (!v.sigma && sensor.quantity == Quantity::angle) v.sigma = r.sigma_th;
      if (form) v.form = form(r.pose, k);
      values.push_back(v);
    }
  }
  return values;
}

std::string channel_name(const Measurements& m, std::size_t channel) {
  constexpr const char* names[] = {"ux", "uy", "uz", "thx", "thy", "thz"};
  return channel < 6 ? names[channel] : m.instruments.sensors.at(channel - 6).name;
}

}  // namespace deflect::measurement
