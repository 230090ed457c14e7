#include "msa/base/set_valued_laws.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "msa/base/convex_search.h"
#include "msa/base/index.h"

namespace deflect {
namespace {

using Outcome = SetValuedSolution::Outcome;

// Of eigenvalues between 0 and 1: what is the rounding of 0 or of 1. Of the largest s: what is no load.
constexpr double rounding = 1e-11, unloaded = 1e-9;
constexpr double kink = 1e-9;  // of half: how far a law must be beyond it

bool endless(const ScalarLaw& law) { return law.half > 0 && !std::isfinite(law.low); }

/// In the units √c of d and 1/√c of s, where c = 1, and the eigenvectors V of P:
///   d = d0 + V √p x,   stored: ½ Σ (1 − p) x² − d0ᵀV √p x.
class Laws {
 public:
  Laws(const LinearRelation& r, const std::vector<ScalarLaw>& laws, const MatrixX& watched)
      : relation_(r), laws_(laws), n_(r.c.size()), unit_(r.c.cwiseSqrt()), watched_(watched) {
    const MatrixX P = unit_.cwiseInverse().asDiagonal() * r.P * unit_.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<MatrixX> eigen(MatrixX((P + P.transpose()) / 2));
    const VectorX d0 = r.d0.cwiseQuotient(unit_), along = eigen.eigenvectors().transpose() * d0;
    std::vector<Eigen::Index> moving;
    for (Eigen::Index j = 0; j < n_; ++j)
      if (eigen.eigenvalues()(j) > rounding) moving.push_back(j);
    const auto k = std::ssize(moving);
    problem_.a.resize(k), problem_.b.resize(k), problem_.B.resize(n_, k);
    start_.resize(k);
    problem_.e = d0;
    if (n_ > 0) problem_.rounding = 1e-15 * r.size.cwiseProduct(unit_).maxCoeff();
    for (Eigen::Index m = 0; m < k; ++m) {
      const Eigen::Index j = nth(moving, m);
      const double p = std::min(eigen.eigenvalues()(j), 1.0), root = std::sqrt(p);
      problem_.a(m) = 1 - p > rounding ? 1 - p : 0;
      problem_.b(m) = root * along(j);
      problem_.B.col(m) = root * eigen.eigenvectors().col(j);
      start_(m) = -along(j) / root;  // d = 0
    }
    for (Eigen::Index i = 0; i < n_; ++i) {
      const ScalarLaw& law = laws_[at(i)];
      const double u = unit_(i);
      problem_.rows.push_back({law.low / u, law.high / u, [&law, u](double d) { return law.force(u * d) * u; },
                               [&law, u](double d) { return law.tangent(u * d) * u * u; }});
      if (problem_.B.row(i).norm() <= rounding) leave_at_rest(i);
    }
  }

  SetValuedSolution solve() {
    if (!feasible()) return {Outcome::no_fit, {}, {}, {}, {}, {}, {}, {}, {}};
    const ConvexAnswer found = least(problem_, start_, likely_ends());
    SetValuedSolution out;
    out.end.assign(at(n_), 0);
    if (found.outcome == ConvexAnswer::Outcome::unbounded) {
      out.outcome = Outcome::overcome;
      out.along = found.along.cwiseProduct(unit_);
      return out;
    }
    if (found.outcome == ConvexAnswer::Outcome::undecided) return out;
    out.outcome = Outcome::solved;
    x_ = found.x, d_ = found.y;
    s_ = found.push;
    for (Eigen::Index i = 0; i < n_; ++i) {
      const ConvexRow& row = problem_.rows[at(i)];
      if (found.side[at(i)] != 0) d_(i) = found.side[at(i)] > 0 ? row.high : row.low;
      s_(i) += row.slope(d_(i));
    }
    bool coarse = !keeps_relation();
    for (Eigen::Index i = 0; i < n_; ++i)
      // A law whose s is lost in the rounding of d.
      coarse = coarse || (found.side[at(i)] == 0 && problem_.rows[at(i)].curvature(d_(i)) > 1e2);
    if (coarse) refine(found.side);
    const double own = s_.size() ? s_.cwiseAbs().maxCoeff() : 0;
    for (Eigen::Index i = 0; i < n_; ++i) {
      const double size = std::max(own, relation_.size(i) * unit_(i));
      if (std::abs(s_(i)) <= 1e-12 * size) s_(i) = 0;
      const ScalarLaw& law = laws_[at(i)];
      const double aside = d_(i) * unit_(i) - law.middle;
      if (endless(law))
        out.end[at(i)] = std::abs(aside) > law.half * (1 + kink) ? (aside > 0 ? 1 : -1) : 0;
      else if (found.side[at(i)] != 0 && std::abs(s_(i) - problem_.rows[at(i)].slope(d_(i))) > unloaded * size)
        out.end[at(i)] = found.side[at(i)];
    }
    centre(out);
    out.d = d_.cwiseProduct(unit_);
    for (Eigen::Index i = 0; i < n_; ++i) {
      const ScalarLaw& law = laws_[at(i)];
      const int end = endless(law) ? 0 : out.end[at(i)];
      out.d(i) = end > 0 ? law.high : end < 0 ? law.low : std::clamp(out.d(i), law.low, law.high);
    }
    out.s = s_.cwiseQuotient(unit_);
    out.o = out.d - relation_.c.cwiseProduct(out.s);
    return out;
  }

 private:
  static std::size_t at(Eigen::Index i) { return as_size(i); }

  /// A law whose d the relation fixes: of the s that it may have there, it takes that of its force, none of an end.
  void leave_at_rest(Eigen::Index i) {
    ConvexRow& row = problem_.rows[at(i)];
    const double size = std::max(problem_.e.norm(), relation_.size.cwiseProduct(unit_).norm());
    if (beyond(i, problem_.e(i)) > 1e-9 * size) return;  // it fits nowhere
    const double s = row.slope(std::clamp(problem_.e(i), row.low, row.high));
    row = {-infinite, infinite, [s](double) { return s; }, [](double) { return 0.0; }};
    problem_.B.row(i).setZero();
  }

  /// Moves the start to where d is within all bounds; false where there is no such place.
  bool feasible() {
    if (within_bounds(start_, 1e-13)) return true;
    ConvexProblem to = problem_;
    to.a.setZero();
    to.b.setZero();
    for (ConvexRow& row : to.rows) {
      const double low = row.low, high = row.high;
      row.slope = [low, high](double d) { return d - std::clamp(d, low, high); };
      row.curvature = [low, high](double d) { return d < low || d > high ? 1.0 : 0.0; };
      row.low = -infinite, row.high = infinite;
    }
    start_ = least(to, start_).x;
    return within_bounds(start_, 1e-9);
  }

  /// The ends at which laws with slack would push if no law moved, which most of them do in the end: the start moves
  /// there. None where they do not fit together.
  std::vector<int> likely_ends() {
    std::vector<int> sides(at(n_), 0);
    std::vector<Eigen::Index> pushed;
    std::vector<double> ends;
    for (Eigen::Index i = 0; i < n_; ++i) {
      const ConvexRow& row = problem_.rows[at(i)];
      if (!(laws_[at(i)].half > 0) || endless(laws_[at(i)]) || !std::isfinite(row.low)) continue;
      const double push = problem_.e(i) - row.slope((row.low + row.high) / 2);
      if (push == 0) continue;
      sides[at(i)] = push > 0 ? 1 : -1;
      pushed.push_back(i);
      ends.push_back((push > 0 ? row.high : row.low) - problem_.e(i));
    }
    if (pushed.empty()) return {};
    const MatrixX B = problem_.B(pushed, Eigen::all);
    Eigen::CompleteOrthogonalDecomposition<MatrixX> solver;
    solver.setThreshold(rounding);
    solver.compute(B);
    if (solver.rank() < B.rows()) return {};
    const VectorX lacking = Eigen::Map<const VectorX>(ends.data(), B.rows()) - B * start_;
    const VectorX x = start_ + solver.solve(lacking);
    if (!within_bounds(x, 1e-13)) return {};
    start_ = x;
    return sides;
  }

  /// But for so much of the size of d.
  bool within_bounds(const VectorX& x, double rounding_of_d) const {
    const VectorX y = problem_.e + problem_.B * x;
    const double size = std::max(problem_.e.norm(), relation_.size.cwiseProduct(unit_).norm());
    double outside = 0;
    for (Eigen::Index i = 0; i < n_; ++i) outside = std::max(outside, beyond(i, y(i)));
    return outside <= rounding_of_d * size;
  }

  double beyond(Eigen::Index i, double d) const {
    return std::abs(d - std::clamp(d, problem_.rows[at(i)].low, problem_.rows[at(i)].high));
  }

  /// Whether d and s are on the relation as it is given, but for the rounding of the search. That takes P for
  /// symmetric: even where P is so but for rounding, the rest counts where an o is large beside others, as behind a
  /// wide gap.
  bool keeps_relation() const {
    const MatrixX P = unit_.cwiseInverse().asDiagonal() * relation_.P * unit_.asDiagonal();
    const VectorX d0 = relation_.d0.cwiseQuotient(unit_), o = d_ - s_;
    const VectorX off = (d0 + P * o - d_).cwiseAbs(), of = d0.cwiseAbs() + P.cwiseAbs() * o.cwiseAbs() + d_.cwiseAbs();
    return (P - P.transpose()).cwiseAbs().maxCoeff() < 1e-8 && (off.array() <= 1e-9 * of.array()).all();
  }

  /// Newton on the relation as it is given, with the ends that push; the sides of `end` stay where they are.
  void refine(const std::vector<int>& end) {
    const MatrixX P = unit_.cwiseInverse().asDiagonal() * relation_.P * unit_.asDiagonal();
    const VectorX d0 = relation_.d0.cwiseQuotient(unit_);
    VectorX o = d_ - s_;
    double before = infinite;
    for (int pass = 0; pass < 10; ++pass) {
      const VectorX d = d0 + P * o, s = d - o;
      VectorX lacking(n_);
      MatrixX J(n_, n_);
      for (Eigen::Index i = 0; i < n_; ++i) {
        const ConvexRow& row = problem_.rows[at(i)];
        const bool held = end[at(i)] != 0;
        const double here = held ? (end[at(i)] > 0 ? row.high : row.low) : std::clamp(d(i), row.low, row.high);
        const double k = held ? 0 : row.curvature(here), weight = 1 / (1 + k);
        lacking(i) = held ? here - d(i) : weight * (s(i) - row.slope(here));
        J.row(i) = held ? VectorX(P.row(i)) : VectorX(weight * ((k - 1) * P.row(i)));
        if (!held) J(i, i) += weight;
      }
      const double now = lacking.norm();
      if (!(now < 0.5 * before)) break;
      before = now;
      d_ = d, s_ = s;
      for (Eigen::Index i = 0; i < n_; ++i) {
        const ConvexRow& row = problem_.rows[at(i)];
        if (end[at(i)] != 0) d_(i) = end[at(i)] > 0 ? row.high : row.low;
        d_(i) = std::clamp(d_(i), row.low, row.high);
        if (end[at(i)] == 0 && row.curvature(d_(i)) <= 1) s_(i) = row.slope(d_(i));
      }
      if (now == 0) break;
      Eigen::CompleteOrthogonalDecomposition<MatrixX> solver;
      solver.setThreshold(rounding);
      o += solver.compute(J).solve(lacking);
    }
  }

  /// Where law i has slack: none, or from .. to of d.
  bool slack(Eigen::Index i, const SetValuedSolution& s, double& from, double& to) const {
    const ScalarLaw& law = laws_[at(i)];
    const int end = s.end[at(i)];
    if (!(law.half > 0) || endless(law) != (end != 0)) return false;
    from = end == 0 ? law.low : end > 0 ? law.middle + law.half : -infinite;
    to = end == 0 ? law.high : end > 0 ? infinite : law.middle - law.half;
    return true;
  }

  /// Directions of x that change nothing but the d of laws with slack.
  MatrixX free_directions(const std::vector<Eigen::Index>& loose) const {
    MatrixX held = problem_.a.asDiagonal();
    for (Eigen::Index i = 0; i < n_; ++i)
      if (std::find(loose.begin(), loose.end(), i) == loose.end())
        held += problem_.B.row(i).transpose() * problem_.B.row(i);
    if (held.rows() == 0) return held;
    const Eigen::SelfAdjointEigenSolver<MatrixX> eigen(held);
    Eigen::Index free = 0;
    while (free < held.rows() && eigen.eigenvalues()(free) <= rounding) ++free;
    return eigen.eigenvectors().leftCols(free);
  }

  /// The middle of the slack, and its extent.
  void centre(SetValuedSolution& out) {
    out.least = out.most = VectorX::Zero(watched_.rows());
    out.loose.resize(n_, 0);
    std::vector<Eigen::Index> loose;
    std::vector<double> half;
    ConvexProblem middle;
    for (Eigen::Index i = 0; i < n_; ++i) {
      double from = 0, to = 0;
      if (!slack(i, out, from, to)) continue;
      const ScalarLaw& law = laws_[at(i)];
      loose.push_back(i);
      half.push_back(law.half / unit_(i));
      middle.rows.push_back({(from - law.middle) / law.half, (to - law.middle) / law.half, [](double v) { return v; },
                             [](double) { return 1.0; }});
    }
    if (loose.empty()) return;
    const MatrixX N = free_directions(loose);
    MatrixX moves = problem_.B * N;  // of d
    for (Eigen::Index i = 0; i < n_; ++i)
      if (moves.row(i).norm() <= 1e-8 * problem_.B.row(i).norm()) moves.row(i).setZero();
    const auto k = std::ssize(loose);
    if (N.cols() == 0) return;
    MatrixX relative(k, N.cols());
    middle.e.resize(k);
    for (Eigen::Index m = 0; m < k; ++m) {
      const Eigen::Index i = loose[at(m)];
      relative.row(m) = moves.row(i) / half[at(m)];
      const double v = d_(i) / half[at(m)] - laws_[at(i)].middle / laws_[at(i)].half;
      middle.e(m) = std::clamp(v, middle.rows[at(m)].low, middle.rows[at(m)].high);
    }
    Eigen::HouseholderQR<MatrixX> qr(relative);
    middle.B = leading_columns(qr.householderQ(), N.cols());
    const MatrixX R = qr.matrixQR().topRows(N.cols()).triangularView<Eigen::Upper>();
    const MatrixX per_step = R.transpose().triangularView<Eigen::Lower>().solve(moves.transpose()).transpose();
    middle.a = middle.b = VectorX::Zero(N.cols());
    middle.rounding = 1e-15;  // of the halves
    const ConvexAnswer found = least(middle, VectorX::Zero(N.cols()));
    for (const Eigen::Index i : loose) d_(i) += per_step.row(i).dot(found.x);
    out.loose = unit_.asDiagonal() * per_step;
    extent(middle, found.x, out);
  }

  void extent(ConvexProblem middle, const VectorX& x, SetValuedSolution& out) const {
    for (ConvexRow& row : middle.rows) row.slope = row.curvature = [](double) { return 0.0; };
    middle.rounding = 0;
    const MatrixX per_step = watched_ * out.loose;
    for (Eigen::Index w = 0; w < watched_.rows(); ++w)
      for (const double sign : {-1.0, 1.0}) {
        middle.b = sign * per_step.row(w).transpose();
        const ConvexAnswer far = least(middle, x);
        const bool bounded = far.outcome == ConvexAnswer::Outcome::least;
        (sign < 0 ? out.least : out.most)(w) = bounded ? per_step.row(w).dot(far.x - x) : sign * infinite;
      }
  }

  const LinearRelation& relation_;
  const std::vector<ScalarLaw>& laws_;
  Eigen::Index n_;
  VectorX unit_;
  MatrixX watched_;
  ConvexProblem problem_;
  VectorX start_, x_, d_, s_;
};

/// Whether law i is at an end and its s pushes it there wherever the others go between their bounds. Only of a law that
/// is coupled to the others, and to itself, by less than a thousandth: its o hardly changes then.
bool stays_at_its_end(const LinearRelation& r, const VectorX& o, const std::vector<ScalarLaw>& laws, Eigen::Index i) {
  const ScalarLaw& law = nth(laws, i);
  if (!std::isfinite(law.low) || !std::isfinite(law.high)) return false;
  const double d = r.d0(i) + r.P.row(i).dot(o), s = (d - o(i)) / r.c(i), end = s > 0 ? law.high : law.low;
  if (std::abs(d - end) > 1e-3 * (law.high - law.low)) return false;
  double most = std::abs(law.force(end));  // of what the others may add
  for (Eigen::Index k = 0; k < o.size(); ++k) {
    const double coupling = std::abs((k == i ? 1 : 0) - r.P(i, k));
    if (coupling * std::sqrt(r.c(k) / r.c(i)) > 1e-3) return false;
    if (coupling > 0) most += coupling / r.c(i) * (nth(laws, k).high - nth(laws, k).low);
  }
  return std::abs(s) > most;
}

}  // namespace

LinearRelation monotone(LinearRelation r, const VectorX& o, const std::vector<ScalarLaw>& laws) {
  const auto change_to = [&](const MatrixX& P) {
    r.d0 += (r.P - P) * o;
    r.P = P;
  };
  MatrixX P = r.P;
  for (Eigen::Index i = 0; i < o.size(); ++i)
    if (stays_at_its_end(r, o, laws, i)) {
      P.row(i).setZero();
      P.col(i).setZero();
      P(i, i) = 1;
    }
  change_to(P);
  const VectorX unit = r.c.cwiseSqrt();
  P = unit.cwiseInverse().asDiagonal() * r.P * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixX> eigen(MatrixX((P + P.transpose()) / 2));
  const VectorX beyond = eigen.eigenvalues() - eigen.eigenvalues().cwiseMax(0).cwiseMin(1);
  const MatrixX excess = eigen.eigenvectors() * beyond.asDiagonal() * eigen.eigenvectors().transpose();
  change_to(r.P - unit.asDiagonal() * excess * unit.cwiseInverse().asDiagonal());
  return r;
}

SetValuedSolution solve(const LinearRelation& r, const std::vector<ScalarLaw>& laws, const MatrixX& watched) {
  return Laws(r, laws, watched).solve();
}

double deflection_at_sum(const ScalarLaw& law, double c, double p, double start) {
  const auto lacks = [&](double d) { return p - d - c * law.force(d); };  // falls by more than d grows
  if (std::isfinite(law.low) && lacks(law.low) <= 0) return law.low;
  if (std::isfinite(law.high) && lacks(law.high) >= 0) return law.high;
  double d = std::clamp(start, law.low, law.high), here = lacks(d);
  double low = here > 0 ? d : std::max(law.low, d + here), high = here > 0 ? std::min(law.high, d + here) : d;
  for (int i = 0; i < 200 && std::abs(here) > 4e-16 * std::max(std::abs(p), std::abs(d)); ++i) {
    double next = d + here / (1 + c * law.tangent(d));
    if (i % 4 == 3 || !(next >= low && next <= high)) next = low + (high - low) / 2;
    if (std::abs(next - d) <= 1e-16 * std::abs(d)) return next;
    d = next, here = lacks(d);
    (here > 0 ? low : high) = d;
  }
  return d;
}

}  // namespace deflect
