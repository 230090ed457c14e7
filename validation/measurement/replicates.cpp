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

std::vector<MeasuredValue> measured_values(const Measurements& m) {
  const PureError estimated = pure_error(m);
  std::vector<MeasuredValue> values;
  for (std::size_t i = 0; i < m.readings.size(); ++i)
    for (std::size_t component = 0; component < 6; ++component) {
      const Reading& r = m.readings[i];
      if (!r.displacement[component]) continue;
      std::optional<double> sigma = component < 3 ? r.sigma_u : r.sigma_th;
      const auto& otherwise = component < 3 ? estimated.u : estimated.th;
      if (!sigma && otherwise) sigma = otherwise->sigma;
      values.push_back({i, component, *r.displacement[component], sigma});
    }
  return values;
}

}  // namespace deflect::measurement
