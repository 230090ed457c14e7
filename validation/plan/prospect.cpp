#include "validation/plan/prospect.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "validation/parallel/cases.h"
#include "validation/statistics/columns.h"

namespace deflect::plan {
namespace {

using measurement::MeasuredValue;
using measurement::Measurements;

/// σ of every number: its own, that of its channel in the data, or what is known of its quantity.
std::vector<double> sigma_of(const std::vector<MeasuredValue>& values, Eigen::Index known, const Measurements& m,
                             const Noise& noise) {
  std::map<std::size_t, std::pair<double, double>> squares;  // of the data: sum, number
  for (Eigen::Index i = 0; i < known; ++i)
    if (const MeasuredValue& v = nth(values, i); v.sigma) {
      auto& [sum, n] = squares[v.channel];
      sum += *v.sigma * *v.sigma, n += 1;
    }
  std::vector<double> out;
  for (const MeasuredValue& v : values) {
    std::optional<double> sigma = v.sigma;
    const auto of_channel = squares.find(v.channel);
    if (!sigma && of_channel != squares.end()) sigma = std::sqrt(of_channel->second.first / of_channel->second.second);
    if (!sigma && v.quantity == measurement::Quantity::length) sigma = noise.u;
    if (!sigma && v.quantity == measurement::Quantity::angle) sigma = noise.th;
    if (!sigma)
      throw InputError(
          fmt::format("{}: nobody knows the noise of {}: give --sigma (--sigma-rotation), a column "
                      "sigma_u_mm (sigma_th_rad), or sigma of the sensor in the description",
                      m.origin, measurement::channel_name(m, v.channel)));
    out.push_back(*sigma);
  }
  return out;
}

constexpr double gross = 6;  // standard deviations of noise and tolerances

/// (1 + O Oᵀ)^(−1/2) = 1 − O less Oᵀ (whitening.h).
MatrixX less_of(const MatrixX& O) {
  const Eigen::SelfAdjointEigenSolver<MatrixX> axes(O.transpose() * O);
  const Eigen::ArrayXd root = (1 + axes.eigenvalues().array().max(0)).sqrt();
  return axes.eigenvectors() * (root * (1 + root)).inverse().matrix().asDiagonal() * axes.eigenvectors().transpose();
}

}  // namespace

Prospect::Prospect(const subject::Subject& s, Possible p, const Noise& noise, const parallel::Work& work,
                   const std::optional<subject::Subject>& right)
    : possible_(std::move(p)), standing_(s.stand(possible_.all)) {
  const Measurements& all = possible_.all;
  values_ = measurement::measured_values(all, standing_->sensor_forms(all));
  first_.assign(all.readings.size() + 1, std::ssize(values_));
  for (auto i = std::ssize(values_); i-- > 0;) first_[nth(values_, i).reading] = i;
  for (std::size_t r = all.readings.size(); r-- > 0;) first_[r] = std::min(first_[r], first_[r + 1]);
  known_ = first_[possible_.taken];
  statistics::ToleranceModel model = statistics::tolerance_model(*standing_, all, values_, work);
  for (const subject::Tolerance& t : model.nuisances)
    if (!t.pose) names_.push_back(t.name);
  prediction::PredictionOptions linear;
  linear.geometry = Geometry::linear;
  const auto deflecting = right ? right->stand(all, standing_.get()) : standing_;
  const statistics::LoadErrors load_errors(right.value_or(s), *deflecting, all,
                                           deflecting->predict(all, linear, work.quiet()));
  uncertainty_.emplace(model.A, values_, sigma_of(values_, known_, all, noise), load_errors);
  tolerances_ = white(model.A.shared);
  const auto alone = [&](Measurements m) {
    std::shared_ptr<const subject::Standing> standing = s.stand(m);
    return Alone{std::move(m), std::move(standing)};
  };
  if (possible_.taken > 0) data_ = alone(possible_.data());
  if (possible_.sequences)
    for (const Block& b : possible_.blocks) alone_.push_back(alone(measurement::one_pose(all, b.pose)));
  own_.resize(all.poses.size());
  for (statistics::GroupColumns& g : uncertainty_->whitening()->groups_by_noise())
    own_[all.readings[nth(values_, g.rows.front()).reading].pose] = std::move(g);
  taken_ = tolerances_.topRows(known_);
  eliminate_errors_of_poses(taken_);
  information_.compute(MatrixX::Identity(taken_.cols(), taken_.cols()) + taken_.transpose() * taken_);
}

VectorX Prospect::predicted(const subject::Subject& s) const {
  const Measurements& all = possible_.all;
  prediction::PredictionOptions o;
  o.geometry = Geometry::linear;
  const std::shared_ptr<const subject::Standing> standing = s.stand(all, standing_.get());
  if (!possible_.sequences || !standing->has_history())
    return statistics::rows_of(values_, standing->predict(all, o, parallel::alone));
  std::vector<VectorX> out;
  const auto add = [&](const Alone& each) {
    const std::vector<VectorX> read =
        s.stand(each.readings, each.standing.get())->predict(each.readings, o, parallel::alone);
    out.insert(out.end(), read.begin(), read.end());
  };
  add(data_);  // the blocks follow it in the order of their readings
  for (const Alone& block : alone_) add(block);
  return statistics::rows_of(values_, out);
}

VectorX Prospect::predicted_of_taken(const subject::Subject& s) const {
  if (known_ == 0) return {};
  prediction::PredictionOptions o;
  o.geometry = Geometry::linear;
  const std::shared_ptr<const subject::Standing> standing = s.stand(data_.readings, data_.standing.get());
  const std::vector<MeasuredValue> values(values_.begin(), values_.begin() + known_);
  return statistics::rows_of(values, standing->predict(data_.readings, o, parallel::alone));
}

void Prospect::eliminate_errors_of_poses(MatrixX& X) const {
  for (const statistics::GroupColumns& g : own_) {
    if (g.rows.empty() || g.rows.back() >= X.rows() || g.columns.cols() == 0) continue;
    const MatrixX part = X(g.rows, Eigen::all);
    X(g.rows, Eigen::all) = part - g.columns * (less_of(g.columns) * (g.columns.transpose() * part));
  }
}

VectorX Prospect::white_of_taken(const VectorX& change) const {
  VectorX whole = VectorX::Zero(numbers());
  whole.head(known_) = change;
  return white(whole).col(0).head(known_);
}

VectorX Prospect::off_taken(const subject::Subject& s) const {
  if (known_ == 0) return {};
  prediction::PredictionOptions o;
  o.geometry = s.true_geometry();
  const std::vector<VectorX> read =
      s.stand(data_.readings, data_.standing.get())->predict(data_.readings, o, parallel::alone);
  const std::vector<MeasuredValue> values(values_.begin(), values_.begin() + known_);
  VectorX y(known_);
  for (Eigen::Index i = 0; i < known_; ++i) y(i) = nth(values, i).value;
  VectorX out = white_of_taken(y - statistics::rows_of(values, read));
  Eigen::ArrayXd variance = 1 + tolerances_.topRows(known_).rowwise().squaredNorm().array();
  for (const statistics::GroupColumns& g : own_)
    for (std::size_t k = 0; k < g.rows.size() && g.columns.cols() > 0; ++k)
      if (g.rows[k] < known_) variance(g.rows[k]) += g.columns.row(as_index(k)).squaredNorm();
  return (out.array().square() > gross * gross * variance).select(0, out);
}

VectorX Prospect::left_of_taken(const VectorX& white) const {
  MatrixX e = white;
  eliminate_errors_of_poses(e);
  const VectorX eta = information_.solve(taken_.transpose() * e);
  VectorX out(known_ + eta.size());
  out << e - taken_ * eta, eta;
  return out;
}

Design Prospect::design(const MatrixX& targets, const MatrixX& beside, const VectorX& prior, bool all) const {
  const Eigen::Index k = tolerances_.cols() + beside.cols(), n = all ? numbers() : known_;
  MatrixX X(n, k + targets.cols());
  X << tolerances_.topRows(n), beside.topRows(n), targets.topRows(n);
  eliminate_errors_of_poses(X);
  const MatrixX M = X.transpose() * X;
  MatrixX information = M.topLeftCorner(k, k);
  information.diagonal().head(tolerances_.cols()).array() += 1;
  information.diagonal().tail(beside.cols()) += prior.cwiseInverse();
  const Eigen::LLT<MatrixX> factor(information);
  const MatrixX alpha = factor.solve(M.topRightCorner(k, targets.cols()));
  MatrixX Q =
      M.bottomRightCorner(targets.cols(), targets.cols()) - M.topRightCorner(k, targets.cols()).transpose() * alpha;
  return {factor.solve(MatrixX::Identity(k, k)), alpha, std::move(Q)};
}

std::pair<Eigen::Index, Eigen::Index> Prospect::numbers_of(std::size_t block) const {
  const Block& b = possible_.blocks[block];
  return {first_[b.first], first_[b.first + b.count] - first_[b.first]};
}

WhiteRows Prospect::rows(std::size_t block, const MatrixX& targets, const MatrixX& beside) const {
  const Block& b = possible_.blocks[block];
  const auto [first, n] = numbers_of(block);
  WhiteRows out;
  out.pose = b.pose;
  out.targets = targets.middleRows(first, n);
  out.shared.resize(n, tolerances_.cols() + beside.cols());
  out.shared << tolerances_.middleRows(first, n), beside.middleRows(first, n);
  out.own = MatrixX::Zero(n, 0);
  if (own_[b.pose].columns.cols() > 0) {
    const statistics::GroupColumns& g = own_[b.pose];
    const Eigen::Index at = std::lower_bound(g.rows.begin(), g.rows.end(), first) - g.rows.begin();
    out.own = g.columns.middleRows(at, n);
  }
  return out;
}

}  // namespace deflect::plan
