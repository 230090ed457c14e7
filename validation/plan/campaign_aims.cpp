#include "validation/plan/campaign_aims.h"

#include <algorithm>
#include <cmath>

namespace deflect::plan {
namespace {

/// What is left of target i beside target k.
double left_of(const MatrixX& Q, Eigen::Index i, Eigen::Index k) {
  return std::max(0.0, Q(i, i) - (Q(k, k) > 0 ? Q(i, k) * Q(i, k) / Q(k, k) : 0));
}

MatrixX none(const Prospect& p) { return MatrixX(p.numbers(), 0); }

}  // namespace

EffectsAim::EffectsAim(const Prospect& p, MatrixX targets)
    : prospect_(&p),
      targets_(std::make_shared<const MatrixX>(std::move(targets))),
      design_(p.design(*targets_, none(p), VectorX(0))) {
  const MatrixX most = p.design(*targets_, none(p), VectorX(0), true).Q();
  for (Eigen::Index i = 0; i < most.cols(); ++i)
    for (Eigen::Index k = 0; k < most.cols(); ++k)
      if (i != k && left_of(most, i, k) > nothing_tells) pairs_.emplace_back(i, k);
  update();
}

double EffectsAim::soft_least(const MatrixX& Q) const {
  if (pairs_.empty()) return 0;
  double least = INFINITY, sum = 0;
  for (const auto& [i, k] : pairs_) least = std::min(least, left_of(Q, i, k));
  for (const auto& [i, k] : pairs_) sum += std::exp((least - left_of(Q, i, k)) / 8);
  return least - 8 * std::log(sum / static_cast<double>(pairs_.size()));
}

WhiteRows EffectsAim::rows(std::size_t block) const { return prospect_->rows(block, *targets_, none(*prospect_)); }

/// With w of a block the left of i beside k grows by (w_i − c w_k)², c = Q_ik/Q_kk, and the value by the mean of it
/// over pairs, weighed by exp(−λ²/8).
void EffectsAim::update() {
  const MatrixX& Q = design_.Q();
  value_ = soft_least(Q);
  slope_ = MatrixX::Zero(Q.rows(), Q.cols());
  double least = INFINITY, sum = 0;
  for (const auto& [i, k] : pairs_) least = std::min(least, left_of(Q, i, k));
  for (const auto& [i, k] : pairs_) {
    const double weight = std::exp((least - left_of(Q, i, k)) / 8), c = Q(k, k) > 0 ? Q(i, k) / Q(k, k) : 0;
    slope_(i, i) += weight;
    slope_(k, k) += weight * c * c;
    slope_(i, k) -= weight * c, slope_(k, i) -= weight * c;
    sum += weight;
  }
  if (sum > 0) slope_ /= sum;
}

double EffectsAim::estimated(std::size_t block, bool taken) const {
  const MatrixX w = design_.innovations(rows(block), taken);
  return (w * slope_).cwiseProduct(w).sum();
}

double EffectsAim::with(std::size_t block) const { return soft_least(design_.with(rows(block))); }

void EffectsAim::take(std::size_t block) {
  design_.take(rows(block));
  update();
}

void EffectsAim::drop(std::size_t block) {
  design_.drop(rows(block));
  update();
}

PrecisionAim::PrecisionAim(const Prospect& p, MatrixX V)
    : prospect_(&p),
      V_(std::make_shared<const MatrixX>(std::move(V))),
      design_(p.design(none(p), none(p), VectorX(0))) {
  value_ = -(*V_ * design_.covariance()).cwiseProduct(*V_).sum() / static_cast<double>(V_->rows());
}

WhiteRows PrecisionAim::rows(std::size_t block) const {
  return prospect_->rows(block, none(*prospect_), none(*prospect_));
}

double PrecisionAim::with(std::size_t block) const {
  return value_ + design_.trace_decrease(rows(block), *V_) / static_cast<double>(V_->rows());
}

void PrecisionAim::take(std::size_t block) {
  value_ = with(block);
  design_.take(rows(block));
}

double PrecisionAim::loss(std::size_t block) const {
  return design_.trace_increase(rows(block), *V_) / static_cast<double>(V_->rows());
}

void PrecisionAim::drop(std::size_t block) {
  value_ -= loss(block);
  design_.drop(rows(block));
}

}  // namespace deflect::plan
