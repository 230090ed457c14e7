#include "msa/base/convex_search.h"
#include "msa/base/index.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace deflect {
namespace {

// Relative: slopes that are rounding, curvatures of a matrix with entries of 1 that are, rates at which a row stays.
constexpr double no_slope = 1e-13, no_curvature = 1e-13, no_rate = 1e-10;
// Above these nothing is lost in rounding: curvatures for Cholesky's method, the rate by which a direction is left out.
constexpr double sure_curvature = 1e-6, sure_rate = 1e-3;

class Search {
 public:
  Search(const ConvexProblem& problem, const VectorX& from, const std::vector<int>& side_at_start)
      : p_(problem), rows_(problem.B.rows()), norms_(problem.B.rowwise().norm()), slopes_(rows_), curvatures_(rows_) {
    out_.x = from;
    out_.push = VectorX::Zero(rows_);
    out_.side = side_at_start;
    out_.side.resize(as_size(rows_), 0);
    for (Eigen::Index i = 0; i < rows_; ++i)
      if (row(i).low == row(i).high) side(i) = 1;
  }

  ConvexAnswer run() {
    const Eigen::Index most = 300 + 60 * rows_;
    for (Eigen::Index round = 0; round < most; ++round) {
      evaluate();
      restrict();
      if (at_rest()) {
        if (let_go()) continue;
        out_.outcome = ConvexAnswer::Outcome::least;
        return out_;
      }
      if (!step()) {
        out_.outcome = ConvexAnswer::Outcome::unbounded;
        return out_;
      }
    }
    return out_;
  }

 private:
  const ConvexRow& row(Eigen::Index i) const { return nth(p_.rows, i); }
  int& side(Eigen::Index i) { return nth(out_.side, i); }

  /// y, the gradient of f, and the size of what it is summed from.
  void evaluate() {
    out_.y = p_.e;
    out_.y.noalias() += p_.B * out_.x;
    for (Eigen::Index i = 0; i < rows_; ++i) {
      out_.y(i) = std::clamp(out_.y(i), row(i).low, row(i).high);
      slopes_(i) = row(i).slope(out_.y(i));
    }
    gradient_ = p_.a.cwiseProduct(out_.x) - p_.b;
    gradient_.noalias() += p_.B.transpose() * slopes_;
    size_ = 0;
    if (p_.b.size() > 0) size_ = std::max(p_.b.cwiseAbs().maxCoeff(), p_.a.cwiseProduct(out_.x).cwiseAbs().maxCoeff());
    for (Eigen::Index i = 0; i < rows_; ++i) size_ = std::max(size_, std::abs(slopes_(i)) * norms_(i));
  }

  /// A basis of the directions along the active bounds; gradient and curvature there.
  void restrict() {
    if (!along_active_) find_directions();
    slope_.noalias() = Z_.transpose() * gradient_;
    noise_ = p_.rounding;
    for (Eigen::Index i = 0; i < rows_; ++i) {
      curvatures_(i) = side(i) == 0 ? row(i).curvature(out_.y(i)) : 0;
      // y may be a small difference of e and B x.
      noise_ = std::max(noise_, 1e-15 * curvatures_(i) * (std::abs(out_.y(i)) + std::abs(p_.e(i))) * norms_(i));
    }
    scaled_ = p_.a.asDiagonal() * Z_;
    H_.noalias() = Z_.transpose() * scaled_;
    scaled_ = curvatures_.asDiagonal() * BZ_;
    H_.noalias() += BZ_.transpose() * scaled_;
  }

  void find_directions() {
    const MatrixX normals = normals_of_active();
    Z_ = MatrixX::Identity(p_.a.size(), p_.a.size());
    if (normals.size() > 0) {
      Eigen::ColPivHouseholderQR<MatrixX> qr;
      qr.setThreshold(no_rate);
      qr.compute(normals);
      Z_ = evaluated(qr.householderQ()).rightCols(p_.a.size() - qr.rank());
    }
    BZ_.noalias() = p_.B * Z_;
    along_active_ = true;
  }

  /// Columns of Bᵀ.
  MatrixX normals_of_active() {
    active_.clear();
    for (Eigen::Index i = 0; i < rows_; ++i)
      if (side(i) != 0) active_.push_back(i);
    MatrixX out(p_.a.size(), std::ssize(active_));
    for (Eigen::Index j = 0; j < out.cols(); ++j) out.col(j) = p_.B.row(nth(active_, j)).transpose();
    return out;
  }

  /// The basis turns until only its last direction changes y_i, which is left out.
  void activate(Eigen::Index i, int at_side) {
    side(i) = at_side;
    VectorX u = BZ_.row(i);
    const double rate = u.norm();
    along_active_ = rate > sure_rate * norms_(i);
    if (!along_active_) return;
    const Eigen::Index last = u.size() - 1;
    u(last) += u(last) < 0 ? -rate : rate;
    u /= u.norm();
    for (MatrixX* of : {&Z_, &BZ_}) {
      moved_.noalias() = *of * u;
      of->noalias() -= 2 * moved_ * u.transpose();
      of->conservativeResize(Eigen::NoChange, last);
    }
  }

  bool at_rest() {
    const double now = slope_.size() ? slope_.cwiseAbs().maxCoeff() : 0;
    if (now <= no_slope * size_ + noise_) return true;
    // Rounding is all that is left where steps no longer gain anything.
    stalled_ = now <= 1e-9 * size_ + 100 * noise_ && now > 0.5 * best_ ? stalled_ + 1 : 0;
    best_ = std::min(best_, now);
    if (stalled_ < 3) return false;
    stalled_ = 0;
    return true;
  }

  /// The bound that pushes the wrong way hardest is let go; false where none does.
  bool let_go() {
    best_ = infinite;
    out_.push.setZero();
    const MatrixX normals = normals_of_active();
    if (normals.size() == 0) return false;
    Eigen::CompleteOrthogonalDecomposition<MatrixX> solver;
    solver.setThreshold(no_rate);
    solver.compute(normals);
    const VectorX push = solver.solve(-gradient_);
    Eigen::Index worst = -1;
    double wrong = 0;
    for (std::size_t j = 0; j < active_.size(); ++j) {
      const Eigen::Index i = active_[j];
      out_.push(i) = push(as_index(j));
      if (row(i).low == row(i).high || i == rounding_let_go_) continue;
      const double here = -side(i) * out_.push(i) * norms_(i);
      if (here > 1e-12 * size_ + noise_ && here > wrong) {
        worst = i;
        if (still_ > rows_) break;  // Bland
        wrong = here;
      }
    }
    if (worst < 0) return false;
    side(worst) = 0;
    last_let_go_ = worst;
    along_active_ = false;
    return true;
  }

  /// Towards where the slope is zero; straight down where there is a slope and no curvature.
  VectorX direction() {
    if (H_.size() == 0) return VectorX::Zero(p_.a.size());
    cholesky_.compute(H_);
    const auto pivots = cholesky_.matrixLLT().diagonal().array().square();
    if (cholesky_.info() == Eigen::Success && pivots.minCoeff() > sure_curvature * std::max(1.0, pivots.maxCoeff()))
      return -Z_ * cholesky_.solve(slope_);
    curvature_.compute(MatrixX((H_ + H_.transpose()) / 2));
    const MatrixX& U = curvature_.eigenvectors();
    const VectorX& l = curvature_.eigenvalues();
    const double least = std::max(no_curvature, 1e-15 * static_cast<double>(l.size()) * l(l.size() - 1));
    const VectorX g = U.transpose() * slope_;
    VectorX flat = VectorX::Zero(g.size()), newton = flat;
    for (Eigen::Index j = 0; j < g.size(); ++j) {
      if (l(j) > least)
        newton(j) = -g(j) / l(j);
      else
        flat(j) = -g(j);
    }
    const double steep = std::sqrt(std::max(g.squaredNorm() - flat.squaredNorm(), 0.0));
    const bool down = flat.norm() > 0.1 * steep || steep <= no_slope * size_ + noise_;
    return Z_ * (U * (down ? flat : newton));
  }

  double rate(const VectorX& d, const VectorX& rates, double t) const {
    double sum = d.dot(p_.a.cwiseProduct(out_.x + t * d) - p_.b);
    for (Eigen::Index i = 0; i < rows_; ++i)
      if (rates(i) != 0) sum += rates(i) * row(i).slope(std::clamp(out_.y(i) + t * rates(i), row(i).low, row(i).high));
    return sum;
  }

  /// False where f falls for ever.
  bool step() {
    const VectorX d = direction();
    VectorX rates = p_.B * d;
    double end = infinite;
    Eigen::Index first = -1;
    for (Eigen::Index i = 0; i < rows_; ++i) {
      if (side(i) != 0 || std::abs(rates(i)) <= no_rate * norms_(i) * d.norm()) {
        if (side(i) != 0) rates(i) = 0;
        continue;
      }
      const double room = rates(i) > 0 ? row(i).high - out_.y(i) : out_.y(i) - row(i).low;
      const double reach = std::max(room, 0.0) / std::abs(rates(i));
      if (reach < end) end = reach, first = i;
    }
    const double falls = rate(d, rates, 0);
    if (first >= 0 && rate(d, rates, end) <= 0) {
      still_ = end == 0 ? still_ + 1 : 0;
      // But for rounding the way from a bound that is let go leads inwards.
      rounding_let_go_ = end == 0 && first == last_let_go_ && still_ > rows_ ? first : end == 0 ? rounding_let_go_ : -1;
      best_ = infinite;
      out_.x += end * d;
      activate(first, rates(first) > 0 ? 1 : -1);
      return true;
    }
    const double length = lowest(d, rates, falls, end);
    if (!std::isfinite(length)) {
      out_.along = rates;
      return false;
    }
    still_ = 0;
    rounding_let_go_ = -1;
    out_.x += length * d;
    return true;
  }

  /// Where f is least along d, before `end`; infinite where it falls for ever.
  double lowest(const VectorX& d, const VectorX& rates, double falls, double end) const {
    const double enough = 1e-9 * std::abs(falls);
    double low = 0, high = std::min(1.0, end), at_low = falls, at_high = rate(d, rates, high);
    // As far as 1e12 times what is known of sizes: nothing turns f there that did not before.
    const double far = 1e12 * std::max({out_.x.norm(), out_.y.norm(), size_}) / d.norm();
    while (at_high < -enough && high < end) {
      if (high > far) return infinite;
      low = high, at_low = at_high;
      high = std::min(16 * high, end);
      at_high = rate(d, rates, high);
    }
    if (std::abs(at_high) <= enough) return high;
    double length = high;
    for (int i = 0; i < 200; ++i) {  // regula falsi (Illinois), halves where the minimum is far nearer
      length = i % 4 == 3 ? (low > 0 ? std::sqrt(low * high) : high / 1024)
                          : (low * at_high - high * at_low) / (at_high - at_low);
      if (!(length > low && length < high)) length = (low + high) / 2;
      const double here = rate(d, rates, length);
      if (std::abs(here) <= enough || high - low <= 1e-15 * high) break;
      if (here > 0) {
        high = length, at_high = here;
        at_low /= low > 0 ? 2 : 1;
      } else {
        low = length, at_low = here;
        at_high /= 2;
      }
    }
    return length;
  }

  const ConvexProblem& p_;
  Eigen::Index rows_;
  VectorX norms_;  // of the rows of B
  ConvexAnswer out_;
  VectorX gradient_, slope_;                       // of f, and along Z
  VectorX slopes_, curvatures_;                    // of the φ
  double size_ = 0, noise_ = 0, best_ = infinite;  // best of the slopes with the same bounds
  std::vector<Eigen::Index> active_;
  MatrixX Z_, BZ_;             // directions along the active bounds, and what they do to y
  bool along_active_ = false;  // whether they are those of the present bounds
  MatrixX H_, scaled_;         // the curvature along Z
  VectorX moved_;
  Eigen::LLT<MatrixX> cholesky_;
  Eigen::SelfAdjointEigenSolver<MatrixX> curvature_;
  int stalled_ = 0;
  Eigen::Index still_ = 0;  // rounds of length zero
  Eigen::Index last_let_go_ = -1, rounding_let_go_ = -1;
};

}  // namespace

ConvexAnswer least(const ConvexProblem& p, const VectorX& x, const std::vector<int>& sides) {
  return Search(p, x, sides).run();
}

}  // namespace deflect
