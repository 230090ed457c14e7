#include "validation/compare/channel_screen.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/frame/file/frame_description.h"
#include "validation/recording/other_quantities.h"

namespace deflect::compare {
namespace {

constexpr double share_of_predicted = 0.01, part_taken_away = 0.4, worse_by = 5;
constexpr double beyond_chance = 30, largest_factor = 2;
constexpr double most_of_misfit = 0.8, far_less = 1.0 / 36;

prediction::PredictionOptions in_linear_geometry() {
  prediction::PredictionOptions o;
  o.geometry = Geometry::linear;
  return o;
}

bool has_free_zero(const subject::Subject& subject, const std::string& sensor) {
  const frame::FrameSensor* found = subject.frame() ? find(subject.frame()->sensors, sensor) : nullptr;
  return found && found->free_zero;
}

/// Of these sensors in place of those that the measurements have: by reading, after the first six numbers.
std::optional<std::vector<VectorX>> predicted_by(const subject::Subject& subject, measurement::Measurements m,
                                                 const std::vector<recording::OtherQuantity>& all,
                                                 const measurement::SensorChannel& channel, int threads) {
  frame::FrameDescription f = *subject.frame();
  m.instruments.sensors.clear();
  for (const recording::OtherQuantity& each : all) {
    f.sensors.emplace_back(each.correction.id, each.shown);
    m.instruments.sensors.push_back({each.correction.id, channel.quantity, channel.sigma});
  }
  for (measurement::Reading& r : m.readings) r.sensors.assign(all.size(), std::nullopt);
  const subject::Subject with(std::move(f));
  return outcome_of([&] { return with.stand(m)->predict(m, {}, {threads}); }).value;
}

/// χ² of numbers y against p, each off by e, from their means where the zero is free.
double chi2_of(const VectorX& y, const VectorX& p, const VectorX& e, bool free_zero) {
  const VectorX weight = e.cwiseAbs2().cwiseInverse();
  const VectorX off = y - p;
  const double zero = free_zero ? off.dot(weight) / weight.sum() : 0;
  return (off.array() - zero).square().matrix().dot(weight);
}

}  // namespace

ChannelScreen::ChannelScreen(const subject::Subject& subject, const Comparison& c, int threads)
    : subject_(subject), study_(&c.study), threads_(threads), scale_(6 + c.study.data->instruments.sensors.size(), 0) {
  std::vector<double> predicted(scale_.size(), 0), sigma(scale_.size(), 0), count(scale_.size(), 0);
  for (std::size_t i = 0; i < study_->values.size(); ++i) {
    const measurement::MeasuredValue& v = study_->values[i];
    predicted[v.channel] += std::pow(study_->predicted[v.reading](as_index(v.channel)), 2);
    sigma[v.channel] += c.sigma[i] * c.sigma[i];
    count[v.channel] += 1;
  }
  for (std::size_t k = 0; k < scale_.size(); ++k)
    if (count[k] > 0)
      scale_[k] = std::sqrt((sigma[k] + share_of_predicted * share_of_predicted * predicted[k]) / count[k]);
  deviation_ = expected_deviations(c);
  double noise = 0;
  for (std::size_t i = 0; i < study_->values.size(); ++i)
    if (const double s = scale_[study_->values[i].channel]; s > 0)
      noise += std::log1p(std::pow(deviation_(as_index(i)) / s, 2));
  const auto n = static_cast<double>(std::max<std::size_t>(1, study_->values.size()));
  as_recorded_ = loss(*study_->data, study_->predicted);
  if (subject_.geometry() != Geometry::linear) {
    const auto linear =
        outcome_of([&] { return study_->standing->predict(*study_->data, in_linear_geometry(), {threads_}); });
    for (std::size_t i = 0; linear && i < linear->size(); ++i) shape_.push_back(study_->predicted[i] - (*linear)[i]);
  }
  promising_ = as_recorded_ - part_taken_away * std::max(0.0, as_recorded_ - noise / n);
  equal_within_ = worse_by / n;
}

double ChannelScreen::loss(const measurement::Measurements& data, const std::vector<VectorX>& predicted) const {
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < data.readings.size(); ++i)
    for (std::size_t k = 0; k < data.instruments.sensors.size(); ++k) {
      const auto& y = data.readings[i].sensors[k];
      if (!y || !(scale_[6 + k] > 0)) continue;
      sum += std::log1p(std::pow((*y - predicted[i](as_index(6 + k))) / scale_[6 + k], 2));
      n += 1;
    }
  return n > 0 ? sum / n : 0;
}

bool ChannelScreen::follows(const recording::Correction& c) const {
  return std::all_of(c.scaled_channels.begin(), c.scaled_channels.end(),
                     [&](const auto& scaled) { return follows(scaled.first, scaled.second); });
}

bool ChannelScreen::follows(std::size_t channel, double factor) const {
  double zz = 0, zp = 0, z1 = 0, p1 = 0, weight = 0;
  for (std::size_t i = 0; i < study_->values.size(); ++i) {
    const measurement::MeasuredValue& v = study_->values[i];
    const double e = deviation_(as_index(i));
    if (v.channel != channel || !(e > 0)) continue;
    const double z = factor * *study_->data->readings[v.reading].sensors[channel - 6] / e;
    const double p = study_->predicted[v.reading](as_index(channel)) / e;
    zz += z * z, zp += z * p, z1 += z / e, p1 += p / e, weight += 1 / (e * e);
  }
  if (has_free_zero(subject_, study_->data->instruments.sensors[channel - 6].name) && weight > 0)
    zz -= z1 * z1 / weight, zp -= z1 * p1 / weight;
  return 2 * zp - zz > beyond_chance && zp < largest_factor * zz && zz < largest_factor * zp;
}

std::vector<std::pair<recording::Correction, double>> ChannelScreen::other_quantities(const Comparison& c) const {
  std::vector<double> misfit(scale_.size(), 0);
  for (std::size_t i = 0; i < study_->values.size(); ++i)
    if (const double e = deviation_(as_index(i)); e > 0)
      misfit[study_->values[i].channel] += std::pow(c.residual(as_index(i)) / e, 2);
  const auto worst = std::max_element(misfit.begin(), misfit.end());
  const auto channel = as_size(worst - misfit.begin());
  std::vector<std::pair<recording::Correction, double>> out;
  if (!subject_.frame() || channel < 6 || *worst < most_of_misfit * std::reduce(misfit.begin(), misfit.end()))
    return out;
  std::vector<std::size_t> own;
  for (std::size_t i = 0; i < study_->values.size(); ++i)
    if (study_->values[i].channel == channel && deviation_(as_index(i)) > 0) own.push_back(i);
  const measurement::SensorChannel& sensor = study_->data->instruments.sensors[channel - 6];
  const auto all = recording::other_quantities(*study_->data, *subject_.frame(), channel - 6);
  const auto predicted = predicted_by(subject_, *study_->data, all, sensor, threads_);
  if (!predicted) return out;
  const bool free_zero = has_free_zero(subject_, sensor.name);
  const auto n = std::ssize(own);
  VectorX y(n), p(n), before(n), e(n), noise(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const measurement::MeasuredValue& v = study_->values[nth(own, i)];
    y(i) = v.value;
    before(i) = study_->predicted[v.reading](as_index(channel));
    e(i) = deviation_(as_index(nth(own, i)));
    noise(i) = c.sigma[nth(own, i)];
  }
  const double as_named = chi2_of(y, before, e, free_zero);
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (Eigen::Index i = 0; i < n; ++i) p(i) = (*predicted)[study_->values[nth(own, i)].reading](as_index(6 + k));
    const double share = share_of_predicted * p.norm() / std::sqrt(static_cast<double>(n));
    const double chi2 = chi2_of(y, p, (e.array().square() + share * share).sqrt().matrix(), free_zero);
    const VectorX near = (noise.array().square() + share * share).sqrt();
    const double by_following = chi2_of(y, VectorX::Zero(n), near, free_zero) - chi2_of(y, p, near, free_zero);
    if (chi2 < far_less * as_named && by_following > beyond_chance)
      out.emplace_back(all[k].correction, chi2 / static_cast<double>(n));
  }
  return out;
}

bool ChannelScreen::has_other_loads(const measurement::Measurements& data) const {
  // By reading: loads_of() has a row for each component that is loaded, and a correction may load others.
  const auto alike = [](const measurement::Reading& a, const measurement::Reading& b) {
    return a.load == b.load && a.factors == b.factors && a.at_points == b.at_points;
  };
  const std::vector<measurement::Reading>& recorded = study_->data->readings;
  return data.instruments.load_points != study_->data->instruments.load_points ||
         !std::equal(data.readings.begin(), data.readings.end(), recorded.begin(), recorded.end(), alike);
}

double ChannelScreen::loss(const recording::Correction& c) const {
  const measurement::Measurements data = recording::corrected(*study_->data, c);
  if (!has_other_loads(data)) return loss(data, study_->predicted);
  const auto predicted =
      outcome_of([&] { return subject_.stand(data, study_->standing.get())->predict(data, {}, {threads_}); });
  return predicted ? loss(data, *predicted) : std::numeric_limits<double>::infinity();
}

std::optional<double> ChannelScreen::estimated_loss(const recording::Correction& c) const {
  const measurement::Measurements data = recording::corrected(*study_->data, c);
  if (shape_.empty() || !has_other_loads(data)) return std::nullopt;
  auto predicted = outcome_of(
      [&] { return subject_.stand(data, study_->standing.get())->predict(data, in_linear_geometry(), {threads_}); });
  if (!predicted) return std::nullopt;
  for (std::size_t i = 0; i < shape_.size(); ++i) (*predicted)[i] += shape_[i];
  return loss(data, *predicted);
}

}  // namespace deflect::compare
