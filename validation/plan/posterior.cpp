#include "validation/plan/posterior.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "msa/base/index.h"
#include "msa/base/outcome.h"

namespace deflect::plan {
namespace {

constexpr double probe = 1.5, least_grown = 0.7, most_grown = 1.4;  // standard deviations; of the parabola's λ² there
constexpr double loose = 0.5;                                       // standard deviation of a coordinate
constexpr double stride = 0.7;                                      // along it
constexpr int most_strides = 40, most_fits = 6, most_halvings = 5;  // to either side; of the others at each
constexpr double unlikely = 14;                                     // λ² above the least at which a valley ends
constexpr double derivative = 1e-4, settled = 0.01;                 // of coordinates; of λ²
constexpr int proposed = 400;
constexpr double share_of_all = 0.1;  // of the proposals, from all points alike

/// Standard normal coordinates (rows) of so many draws, the first of them zero. Each has the mean 0 and the mean square
/// 1 over all draws, so that the mean of what is quadratic in one coordinate is exact.
MatrixX standardised(Eigen::Index coordinates, Eigen::Index draws, measurement::Random& random) {
  MatrixX out = MatrixX::Zero(coordinates, draws);
  for (Eigen::Index k = 1; k < draws; ++k)
    for (Eigen::Index i = 0; i < coordinates; ++i) out(i, k) = random.normal();
  for (Eigen::Index i = 0; i < coordinates; ++i) {
    auto drawn = out.row(i).tail(draws - 1);
    drawn.array() -= drawn.mean();
    drawn *= std::sqrt(static_cast<double>(draws)) / drawn.norm();
  }
  return out;
}

/// λ² of the readings taken at a point, and its derivatives: λ² = |r|², J of r.
struct Point {
  VectorX at, r;
  double left = INFINITY;
  MatrixX J;
};

class Valley {
 public:
  Valley(const RivalModel& model, const VectorX& fit, VectorX taken)
      : model_(model), taken_(std::move(taken)), fit_(with_slope(fit)) {}

  const Point& fit() const { return fit_; }

  double left(const VectorX& x) const {
    const std::optional<VectorX> r = model_.residual_of_taken(x, taken_);
    return r ? r->squaredNorm() : INFINITY;
  }

  /// Whether λ² about the fit, probed along the axes of the covariance, is the parabola of its derivatives.
  bool is_parabola(const MatrixX& root) const {
    for (Eigen::Index i = 0; i < root.cols(); ++i)
      for (const double by : {probe, -probe}) {
        const double grown = (left(fit_.at + by * root.col(i)) - fit_.left) / (by * by);
        if (!(grown > least_grown && grown < most_grown)) return false;
      }
    return true;
  }

  /// From the fit on along a coordinate, by strides of that sense, until λ² is unlikely or a bound is reached.
  std::vector<Point> along(Eigen::Index i, double sense) const {
    std::vector<Point> out;
    VectorX slope = VectorX::Zero(fit_.at.size());
    for (Point last = fit_; std::ssize(out) < most_strides;) {
      VectorX x = model_.within(last.at + stride * sense * VectorX::Unit(slope.size(), i));
      const double length = std::abs(x(i) - last.at(i));
      if (length < loose * stride) break;  // at the bound
      const double there = x(i);
      x = model_.within(x + length * slope);
      x(i) = there;
      Point next = fitted_beside(x, i);
      if (!(next.left < fit_.left + unlikely)) break;
      slope = (next.at - last.at) / length;
      slope(i) = 0;
      out.push_back(next);
      last = std::move(next);
    }
    return out;
  }

 private:
  Point with_slope(const VectorX& x) const {
    Point out{x, {}, INFINITY, {}};
    const std::optional<VectorX> r = model_.residual_of_taken(x, taken_);
    if (!r) return out;
    out.r = *r, out.left = r->squaredNorm();
    out.J = MatrixX::Zero(r->size(), x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i)
      for (const double by : {derivative, -derivative}) {
        const auto moved = model_.residual_of_taken(x + by * VectorX::Unit(x.size(), i), taken_);
        if (!moved) continue;
        out.J.col(i) = (*moved - *r) / by;
        break;
      }
    return out;
  }

  /// All other coordinates fitted by Gauss–Newton steps, halved where they leave more.
  Point fitted_beside(const VectorX& from, Eigen::Index held) const {
    Point here = with_slope(from);
    for (int fits = 0; fits < most_fits && std::isfinite(here.left); ++fits) {
      MatrixX J = here.J;
      J.col(held).setZero();
      MatrixX H = J.transpose() * J;
      H.diagonal().array() += 1e-6 * std::max(1.0, H.diagonal().maxCoeff());
      const VectorX whole = -H.llt().solve(J.transpose() * here.r);
      double length = 1;
      VectorX best = here.at;
      double least = here.left;
      for (int tries = 0; tries < most_halvings && least == here.left; ++tries, length /= 2) {
        VectorX x = model_.within(here.at + length * whole);
        x(held) = here.at(held);
        if (const double there = left(x); there < least) best = x, least = there;
      }
      const double gained = here.left - least;
      if (gained > 0) here = with_slope(best);
      if (gained < settled) break;
    }
    return here;
  }

  const RivalModel& model_;
  VectorX taken_;
  Point fit_;
};

/// Normals about points of a valley.
class Mixture {
 public:
  explicit Mixture(std::vector<Point> points) : points_(std::move(points)) {
    double least = INFINITY, sum = 0;
    for (const Point& p : points_) least = std::min(least, p.left);
    for (const Point& p : points_) {
      const Eigen::Index n = p.at.size();
      const MatrixX tight = p.J.transpose() * p.J + MatrixX::Identity(n, n) / (stride * stride);
      roots_.push_back(tight.llt().matrixL());
      weights_.push_back(std::exp(-(p.left - least) / 2) / roots_.back().diagonal().prod());
      sum += weights_.back();
    }
    for (double& w : weights_) w = (1 - share_of_all) * w / sum + share_of_all / static_cast<double>(weights_.size());
  }

  VectorX draw(measurement::Random& random) const {
    std::size_t j = 0;
    for (double lot = random.uniform(0, 1); j + 1 < weights_.size() && lot > weights_[j]; ++j) lot -= weights_[j];
    VectorX z(points_[j].at.size());
    for (Eigen::Index i = 0; i < z.size(); ++i) z(i) = random.normal();
    return points_[j].at + roots_[j].transpose().triangularView<Eigen::Upper>().solve(z);
  }

  /// Up to a factor that is the same everywhere.
  double density(const VectorX& x) const {
    double out = 0;
    for (std::size_t j = 0; j < points_.size(); ++j) {
      const VectorX z = roots_[j].transpose() * (x - points_[j].at);
      out += weights_[j] * roots_[j].diagonal().prod() * std::exp(-z.squaredNorm() / 2);
    }
    return out;
  }

 private:
  std::vector<Point> points_;
  std::vector<MatrixX> roots_;  // L of L Lᵀ, the inverse of each covariance
  std::vector<double> weights_;
};

/// Draws with weights of their own, as so many of equal weight: the middle of each share along their longest axis.
MatrixX quantiles(const std::vector<VectorX>& all, const std::vector<double>& weights, Eigen::Index shares) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  VectorX mean = VectorX::Zero(all.front().size());
  for (std::size_t i = 0; i < all.size(); ++i) mean += weights[i] / sum * all[i];
  MatrixX C = MatrixX::Zero(mean.size(), mean.size());
  for (std::size_t i = 0; i < all.size(); ++i) C += weights[i] * (all[i] - mean) * (all[i] - mean).transpose();
  const VectorX axis = Eigen::SelfAdjointEigenSolver<MatrixX>(C).eigenvectors().rightCols(1);
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return axis.dot(all[a]) < axis.dot(all[b]); });
  MatrixX out(mean.size(), shares);
  std::size_t k = 0;
  double below = 0;
  for (Eigen::Index i = 0; i < shares; ++i) {
    const double middle = (static_cast<double>(i) + 0.5) / static_cast<double>(shares) * sum;
    while (k + 1 < order.size() && below + weights[order[k]] < middle) below += weights[order[k++]];
    out.col(i) = all[order[k]];
  }
  return out;
}

}  // namespace

MatrixX draws_of(const RivalModel& model, const Linearised& fit, Eigen::Index draws, measurement::Random& random) {
  const MatrixX P = model.covariance(fit);
  const Eigen::SelfAdjointEigenSolver<MatrixX> axes(P);
  const MatrixX root = axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
  MatrixX out = fit.at.replicate(1, draws);
  const auto normal = [&]() -> MatrixX { return out + root * standardised(fit.at.size(), draws, random); };
  auto taken = outcome_of([&] { return model.taken_as_linear(); });
  if (!taken) return normal();
  const Valley valley(model, fit.at, std::move(*taken.value));
  if (!std::isfinite(valley.fit().left) || valley.is_parabola(root)) return normal();
  std::vector<Point> points = {valley.fit()};
  for (Eigen::Index i = 0; i < fit.at.size(); ++i)
    for (const double sense : {1.0, -1.0})
      if (P(i, i) > loose * loose)
        for (Point& p : valley.along(i, sense)) points.push_back(std::move(p));
  const Mixture mixture(std::move(points));
  std::vector<VectorX> all;
  std::vector<double> weights;
  for (int k = 0; k < proposed; ++k) {
    const VectorX x = mixture.draw(random);
    const double left = valley.left(x);
    if (!std::isfinite(left)) continue;
    all.push_back(x);
    weights.push_back(std::exp(-(left - valley.fit().left) / 2) / mixture.density(x));
  }
  return all.empty() ? out : quantiles(all, weights, draws);
}

}  // namespace deflect::plan
