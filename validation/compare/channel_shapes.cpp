#include "validation/compare/channel_shapes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "msa/base/index.h"
#include "validation/statistics/columns.h"

namespace deflect::compare {
namespace {

constexpr double lags[] = {1e-6, 0.1, 0.3};  // of the largest |p|; the first is next to none

/// p less what an instrument shows that lags by up to `band`, by reading, which are given in the order taken. It is
/// true at each pose's first reading.
VectorX lag(const measurement::Measurements& data, const std::vector<std::size_t>& order, const VectorX& p,
            double band) {
  VectorX out(p.size());
  std::optional<std::size_t> pose;
  double shown = 0;
  for (const std::size_t i : order) {
    const double value = p(as_index(i));
    if (data.readings[i].pose != pose) shown = value;
    pose = data.readings[i].pose;
    shown = std::clamp(shown, value - band, value + band);
    out(as_index(i)) = value - shown;
  }
  return out;
}

/// By reading, from −1 to 1.
VectorX time_of(const std::vector<std::size_t>& order) {
  VectorX out(std::ssize(order));
  const double last = std::max(1.0, static_cast<double>(order.size()) - 1);
  for (std::size_t k = 0; k < order.size(); ++k) out(as_index(order[k])) = 2 * static_cast<double>(k) / last - 1;
  return out;
}

VectorX predicted_of(const ResidualStudy& s, std::size_t channel) {
  VectorX p(std::ssize(s.predicted));
  for (std::size_t i = 0; i < s.predicted.size(); ++i) p(as_index(i)) = s.predicted[i](as_index(6 + channel));
  return p;
}

/// By reading.
MatrixX shapes_of(const ResidualStudy& s, std::size_t channel, const std::vector<std::size_t>& order) {
  const std::vector<measurement::SensorChannel>& sensors = s.data->instruments.sensors;
  const VectorX p = predicted_of(s, channel);
  std::vector<MatrixX> out = {VectorX::Ones(p.size()), p.cwiseAbs(), p};
  for (std::size_t other = 0; other < sensors.size(); ++other)
    if (other != channel && sensors[other].quantity == sensors[channel].quantity) out.push_back(predicted_of(s, other));
  if (!order.empty()) out.push_back(time_of(order));
  for (const double share : lags)
    if (!order.empty()) out.push_back(lag(*s.data, order, p, share * p.cwiseAbs().maxCoeff()));
  return statistics::side_by_side(out, p.size());
}

/// By measured number.
MatrixX shapes_of_motion(const ResidualStudy& s) {
  MatrixX out = MatrixX::Zero(std::ssize(s.values), 8);
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    if (s.values[i].channel >= 6) continue;
    const Vector6 d = s.predicted[s.values[i].reading].head<6>();
    const Vector3 u = d.head<3>(), th = d.tail<3>();
    Eigen::Matrix<double, 6, 8> all = Eigen::Matrix<double, 6, 8>::Zero();
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Vector3 e = Vector3::Unit(k);
      all.col(k).head<3>() = th.cross(e);
      all.col(3 + k) << e.cross(u), e.cross(th);
    }
    all.col(6).head<3>() = u;
    all.col(7).tail<3>() = th;
    out.row(as_index(i)) = all.row(as_index(s.values[i].channel));
  }
  return out;
}

/// Of a channel, rows by measured number.
MatrixX in_channel(const ResidualStudy& s, std::size_t c, const MatrixX& by_reading) {
  MatrixX out = MatrixX::Zero(std::ssize(s.values), by_reading.cols());
  for (std::size_t i = 0; i < s.values.size(); ++i)
    if (s.values[i].channel == 6 + c) out.row(as_index(i)) = by_reading.row(as_index(s.values[i].reading));
  return out;
}

MatrixX without_zeros(const MatrixX& columns) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < columns.cols(); ++k)
    if (!columns.col(k).isZero(0)) kept.push_back(k);
  return columns(Eigen::all, kept);
}

}  // namespace

std::map<std::string, MatrixX> channel_shapes(const ResidualStudy& s) {
  std::vector<std::size_t> order;
  if (s.sequence) order = measurement::in_sequence(*s.data, "the lag of a sensor");
  std::map<std::string, MatrixX> out;
  for (std::size_t c = 0; c < s.data->instruments.sensors.size(); ++c) {
    const MatrixX all = shapes_of(s, c, order);
    out[s.data->instruments.sensors[c].name] = without_zeros(in_channel(s, c, all));
  }
  if (MatrixX motion = without_zeros(shapes_of_motion(s)); motion.cols() > 0) out.emplace("sensor", std::move(motion));
  return out;
}

bool may_lag(const ResidualStudy& s, const std::string& sensor) {
  const auto& all = s.data->instruments.sensors;
  return s.sequence && std::ranges::find(all, sensor, &measurement::SensorChannel::name) != all.end();
}

MatrixX lags_of_channel(const ResidualStudy& s, const std::string& sensor) {
  constexpr int bands = 16;
  if (!may_lag(s, sensor)) return MatrixX(std::ssize(s.values), 0);
  const std::vector<std::size_t> order = measurement::in_sequence(*s.data, "the lag of a sensor");
  const auto& all = s.data->instruments.sensors;
  const auto c = as_size(std::ranges::find(all, sensor, &measurement::SensorChannel::name) - all.begin());
  const VectorX p = predicted_of(s, c);
  std::vector<MatrixX> out;
  for (int i = 1; i <= bands; ++i)
    out.push_back(lag(*s.data, order, p, std::pow(0.5, 0.5 * i) * p.cwiseAbs().maxCoeff()));
  return without_zeros(in_channel(s, c, statistics::side_by_side(out, p.size())));
}

}  // namespace deflect::compare
