#include "validation/compare/correction_screen.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/compare/residual_study.h"
#include "validation/prediction/prediction.h"
#include "validation/recording/recording_mistakes.h"
#include "validation/statistics/uncertainty.h"

namespace deflect::compare {
namespace {

constexpr std::size_t most_sampled = 1000;  // readings
constexpr double of_usual = 0.005, of_predicted = 0.01, good_part = 0.4;
constexpr double clearly_worse = 5;                // of the sum of losses
constexpr double deviations_of_noise = 5;          // of χ²
constexpr double by_chance = 1, clearly_more = 9;  // of χ²
constexpr double gross = 20;  // times the median of |left|/expected: an outlier, even where the model is wrong
constexpr double least_shift_mm = 0.5, most_shift_mm = 100;

/// Some of the readings, spread evenly over the file, at the poses that they have.
std::pair<measurement::Measurements, std::vector<std::size_t>> sample_of(const measurement::Measurements& data) {
  measurement::Measurements out{data.origin, data.joint_rotates, {}, data.temperature_recorded, {}, {},
                                {},          data.instruments};
  std::vector<std::size_t> rows;
  std::vector<std::size_t> pose(data.poses.size(), data.poses.size());
  const std::size_t n = data.readings.size(), wanted = std::min(n, most_sampled);
  for (std::size_t k = 0; k < wanted; ++k) {
    const std::size_t i = k * n / wanted;
    const measurement::Reading& r = data.readings[i];
    if (pose[r.pose] == data.poses.size()) {
      pose[r.pose] = out.poses.size();
      out.poses.push_back(data.poses[r.pose]);
      out.poses.back().readings.clear();
    }
    out.poses[pose[r.pose]].readings.push_back(out.readings.size());
    out.readings.push_back(r);
    out.readings.back().pose = pose[r.pose];
    out.readings.back().notes.clear();
    rows.push_back(i);
  }
  return {std::move(out), std::move(rows)};
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

CorrectionScreen::CorrectionScreen(const subject::Subject& subject, const Comparison& c, int threads)
    : subject_(subject), comparison_(&c), study_(&c.study), threads_(threads), size_(c.study.standing->size()) {
  std::array<double, 2> sum{}, count{};
  for (std::size_t i = 0; i < study_->values.size(); ++i) {
    if (c.estimated[i]) continue;
    const std::size_t of = study_->values[i].quantity == measurement::Quantity::angle ? 1 : 0;
    sum[of] += c.sigma[i] * c.sigma[i], count[of] += 1;
  }
  for (std::size_t of = 0; of < 2; ++of)
    if (count[of] > 0) sigma_[of] = std::sqrt(sum[of] / count[of]);
  std::tie(sample_, rows_) = sample_of(*c.study.data);
  as_recorded_ = loss(recording::Correction{});
  std::size_t numbers = 0;
  for (const measurement::Reading& r : sample_.readings)
    for (const std::optional<double>& d : r.displacement) numbers += d.has_value();
  equal_within_ = clearly_worse / static_cast<double>(std::max<std::size_t>(1, numbers));
  // Noise and tolerances alone, of the size that the comparison has for them.
  std::map<std::pair<std::size_t, std::size_t>, double> scale;
  for (const Difference& d : differences(*study_->data, study_->predicted)) scale[{d.row, d.component}] = d.scale;
  const VectorX tolerances = c.tolerances.A.squared_row_norms();
  double noise = 0;
  for (std::size_t i = 0; i < study_->values.size(); ++i) {
    const measurement::MeasuredValue& v = study_->values[i];
    if (!v.of_tool_point()) continue;
    const double weight = v.quantity == measurement::Quantity::angle ? size_ : 1, s = scale.at({v.reading, v.channel});
    const double variance = (c.estimated[i] ? 0 : c.sigma[i] * c.sigma[i]) + tolerances(as_index(i));
    noise += s > 0 ? std::log1p(weight * weight * variance / (s * s)) + std::log(s) : 0;
  }
  noise /= static_cast<double>(std::max<std::size_t>(1, scale.size()));
  promising_ = as_recorded_ - good_part * std::max(0.0, as_recorded_ - noise);
}

std::vector<CorrectionScreen::Difference> CorrectionScreen::differences(const measurement::Measurements& data,
                                                                        const std::vector<VectorX>& predicted) const {
  std::vector<double> usual;
  for (const measurement::Reading& r : data.readings)
    for (std::size_t k = 0; k < 6; ++k)
      if (r.displacement[k]) usual.push_back(std::abs(*r.displacement[k]) * (k < 3 ? 1 : size_));
  const double usually = of_usual * quantile(usual, 0.75);
  std::vector<Difference> out;
  for (std::size_t i = 0; i < data.readings.size(); ++i)
    for (std::size_t k = 0; k < 6; ++k) {
      const measurement::Reading& r = data.readings[i];
      if (!r.displacement[k]) continue;
      const double weight = k < 3 ? 1 : size_, p = weight * predicted[i](as_index(k));
      const double sigma = weight * (k < 3 ? r.sigma_u.value_or(sigma_[0]) : r.sigma_th.value_or(sigma_[1]));
      out.push_back({i, k, weight * *r.displacement[k] - p, std::hypot(sigma, usually, of_predicted * p)});
    }
  return out;
}

double CorrectionScreen::loss(const measurement::Measurements& data, const std::vector<VectorX>& predicted,
                              const recording::Rewritten& displacement) const {
  const std::vector<Difference> all = differences(data, predicted);
  double sum = 0;
  for (const Difference& d : all)
    if (d.scale > 0)
      sum += std::log1p(std::pow(d.left / d.scale, 2)) + std::log(d.scale / std::abs(displacement.factor[d.component]));
  return all.empty() ? 0 : sum / static_cast<double>(all.size());
}

double CorrectionScreen::loss(const recording::Correction& c) const {
  const measurement::Measurements data = recording::corrected(sample_, c);
  std::vector<VectorX> predicted(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const measurement::Reading& recorded = study_->data->readings[rows_[i]];
    predicted[i] = study_->predicted[rows_[i]];
    predicted[i] += deformed_shape_under(*study_, rows_[i], data.readings[i].load);
    predicted[i].head<6>() += study_->compliance[recorded.pose] * (data.readings[i].load - recorded.load);
  }
  return loss(data, predicted, c.displacement);
}

std::optional<std::vector<VectorX>> CorrectionScreen::predicted_with(const recording::Correction& c) const {
  const measurement::Measurements data = recording::corrected(sample_, c);
  // The subject may not reach a pose, or not stand there.
  auto predicted = outcome_of([&] { return subject_.stand(data)->predict(data, {}, {threads_}); });
  for (std::size_t i = 0; predicted && i < rows_.size(); ++i)
    (*predicted)[i] += deformed_shape_under(*study_, rows_[i], data.readings[i].load);
  return std::move(predicted.value);
}

double CorrectionScreen::loss_elsewhere(const recording::Correction& c) const {
  const auto predicted = predicted_with(c);
  return predicted ? loss(recording::corrected(sample_, c), *predicted, c.displacement)
                   : std::numeric_limits<double>::infinity();
}

std::optional<recording::Correction> CorrectionScreen::best_shift(int axis) const {
  if (sample_.by_joints()) return std::nullopt;
  const auto shifted = [&](double mm) { return recording::shifted_poses(mm * Vector3::Unit(axis)); };
  const auto at = [&](double mm) { return predicted_with(shifted(mm)); };
  // Gauss–Newton on the losses: numbers far off count little.
  double mm = 0, least = as_recorded_;
  for (int step = 0; step < 6; ++step) {
    const auto here = at(mm), beside = at(mm + 0.1);
    if (!here || !beside) return std::nullopt;
    double along = 0, squares = 0;
    for (const Difference& d : differences(sample_, *here)) {
      if (!(d.scale > 0)) continue;
      const auto k = as_index(d.component);
      const double z = d.left / d.scale;
      const double slope = (d.component < 3 ? 1 : size_) * ((*beside)[d.row](k) - (*here)[d.row](k)) / 0.1 / d.scale;
      along += slope * z / (1 + z * z);
      squares += slope * slope / (1 + z * z);
    }
    if (!(squares > 0)) return std::nullopt;
    double further = along / squares;
    bool better = false;
    for (int half = 0; half < 5 && !better; ++half, further /= 2) {
      if (std::abs(mm + further) > most_shift_mm) continue;
      const double loss = loss_elsewhere(shifted(mm + further));
      if (loss < least) least = loss, mm += further, better = true;
    }
    if (!better || std::abs(further) < 0.01) break;
  }
  // The recorded poses minus what they are off by are the true ones.
  return std::abs(mm) >= least_shift_mm ? std::optional(shifted(mm)) : std::nullopt;
}

std::optional<Vector3> CorrectionScreen::point_of_least_loss() const {
  Vector3 p = Vector3::Zero();
  double least = as_recorded_;
  for (int step = 0; step < 6; ++step) {
    const auto here = predicted_with(recording::forces_elsewhere(p));
    if (!here) return std::nullopt;
    const std::vector<Difference> all = differences(sample_, *here);
    // One scale for all: what the loads' point adds is as certain where little moves as where much does.
    std::vector<double> left;
    for (const Difference& d : all) left.push_back(std::abs(d.left));
    const double scale = 3 * quantile(left, 0.5);
    if (!(scale > 0)) break;
    Matrix3 squares = Matrix3::Zero();
    Vector3 along = Vector3::Zero();
    for (const Difference& d : all) {
      const measurement::Reading& r = sample_.readings[d.row];
      const auto k = as_index(d.component);
      // C [0; p × f] = −C_·θ [f]× p
      const Vector3 slope =
          -(d.component < 3 ? 1 : size_) / scale *
          (study_->compliance[study_->data->readings[rows_[d.row]].pose].row(k).tail<3>() * skew(r.load.head<3>()))
              .transpose();
      const double z = d.left / scale, weight = 1 / (1 + z * z);
      squares += weight * slope * slope.transpose();
      along += weight * z * slope;
    }
    const Eigen::LDLT<Matrix3> solver(squares);
    if (!(solver.rcond() > 1e-12)) return std::nullopt;
    Vector3 further = solver.solve(along);
    bool better = false;
    for (int half = 0; half < 5 && !better; ++half, further /= 2)
      if (const double loss = loss_elsewhere(recording::forces_elsewhere(p + further)); loss < least)
        least = loss, p += further, better = true;
    if (!better || further.norm() < 1e-5) break;
  }
  return p;
}

CorrectionScreen::Point CorrectionScreen::weighed_point(const Vector3& p) const {
  const Comparison& c = *comparison_;
  std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>> in_base, in_platform;
  for (const measurement::Reading& r : study_->data->readings) {
    in_base.emplace_back(-study_->compliance[r.pose].rightCols<3>() * skew(r.load.head<3>()));
    in_platform.emplace_back(in_base.back() * study_->standing->tool(r.pose).R_W);
  }
  const MatrixX slopes = statistics::rows_of(study_->values, in_base);
  VectorX residual = c.residual;
  if (!study_->deformed_shape.empty()) residual -= statistics::rows_of(study_->values, study_->deformed_shape);
  const VectorX z = (residual - slopes * p).cwiseQuotient(expected_deviations(c)).cwiseAbs();
  const double usual = quantile({z.begin(), z.end()}, 0.5);
  std::vector<bool> aside(study_->data->readings.size(), false);
  for (Eigen::Index i = 0; i < z.size(); ++i)
    if (z(i) > gross * usual) aside[nth(study_->values, i).reading] = true;
  const statistics::Uncertainty u(c.tolerances.A, study_->values, c.sigma, study_->load_errors, aside, threads_);
  const statistics::Regression fixed = statistics::regress(u, residual, slopes),
                               turning =
                                   statistics::regress(u, residual, statistics::rows_of(study_->values, in_platform));
  const double left = u.inner(residual, residual)(0, 0) - fixed.gain, numbers = static_cast<double>(u.count());
  return {fixed.amplitude, turning.gain - fixed.gain, left < numbers + deviations_of_noise * std::sqrt(2 * numbers)};
}

std::optional<CorrectionScreen::BestPoint> CorrectionScreen::best_point() const {
  const std::optional<Vector3> least = point_of_least_loss();
  if (!least) return std::nullopt;
  const Point point = weighed_point(*least);
  if (point.p.norm() <= 1e-3) return std::nullopt;
  BestPoint out{recording::forces_elsewhere(point.p), 0, point.leaves_noise};
  out.loss = loss_elsewhere(out.correction);
  out.correction.effect_alike = point.more_if_it_turns > (out.loss < promising_ ? by_chance : -clearly_more);
  return out;
}

}  // namespace deflect::compare
