#include "validation/measurement/replicates.h"
#include "msa/base/index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace deflect::measurement {
namespace {

using Six = std::array<double, 6>;

Six to_1e9(const Vector6& load) {
  Six rounded;
  for (std::size_t i = 0; i < 6; ++i) rounded[i] = std::round(load(as_index(i)) * 1e9);
  return rounded;
}

/// Signs of the six changes by which each reading's load was reached; zero without a sequence.
std::vector<Six> directions(const Measurements& m) {
  std::vector<Six> signs(m.readings.size(), Six{});
  if (m.readings.empty() || !m.readings.front().sequence) return signs;
  Six before{};
  std::optional<std::size_t> pose;
  for (const std::size_t i : in_sequence(m, "the direction of loading")) {
    if (m.readings[i].pose != pose) before = {};
    pose = m.readings[i].pose;
    const Six load = to_1e9(m.readings[i].load);
    for (std::size_t k = 0; k < 6; ++k) signs[i][k] = load[k] > before[k] ? 1 : load[k] < before[k] ? -1 : 0;
    before = load;
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
  const std::vector<Six> direction =
      reached == Reached::in_same_direction ? directions(m) : std::vector<Six>(m.readings.size(), Six{});
  std::vector<std::vector<std::size_t>> groups;
  for (const PoseGroup& pose : m.poses) {
    std::map<std::pair<Six, Six>, std::vector<std::size_t>> alike;
    for (const std::size_t i : pose.readings) alike[{to_1e9(m.readings[i].load), direction[i]}].push_back(i);
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

MeasuredValue tool_point_value(std::size_t reading, std::size_t component, double value, std::optional<double> sigma) {
  return {reading, component, value, sigma, component >= 3, Vector6::Unit(as_index(component))};
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
    }
    for (std::size_t k = 0; k < r.sensors.size(); ++k) {
      if (!r.sensors[k]) continue;
      const SensorChannel& sensor = m.instruments.sensors[k];
      MeasuredValue v{i, 6 + k, *r.sensors[k], sensor.sigma, sensor.rotation};
      if (!v.sigma) v.sigma = sigma_of(of_sensors[k]);
      if (!v.sigma) v.sigma = sensor.rotation ? r.sigma_th : r.sigma_u;
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
