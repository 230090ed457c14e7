#include "msa/base/play_alone.h"

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"

namespace deflect {
namespace {

// As in solve(): of eigenvalues of P; of the largest s, what is no load and what is 0.
constexpr double no_coupling = 1e-11, no_load = 1e-9, no_force = 1e-12;

bool has_two_ends(const ScalarLaw& law) { return law.half > 0 && std::isfinite(law.low) && std::isfinite(law.high); }

class PlayAlone {
 public:
  PlayAlone(const LinearRelation&, const std::vector<ScalarLaw>&);

  bool none() const { return alone_.empty(); }
  SetValuedSolution solution_of_others(const MatrixX& watched) const;
  /// All laws, with the solution of the others.
  SetValuedSolution beside(const SetValuedSolution& others, const MatrixX& watched) const;

 private:
  double size() const;  // the largest s of a law alone, in units in which its c is 1

  const LinearRelation& relation_;
  const std::vector<ScalarLaw>& laws_;
  std::vector<Eigen::Index> alone_, others_;
};

PlayAlone::PlayAlone(const LinearRelation& r, const std::vector<ScalarLaw>& laws) : relation_(r), laws_(laws) {
  const VectorX unit = r.c.cwiseSqrt();
  const auto coupled = [&](Eigen::Index i, Eigen::Index k) {
    return std::abs(r.P(i, k) - (i == k ? 1 : 0)) * unit(k) / unit(i) > no_coupling;
  };
  for (Eigen::Index i = 0; i < r.c.size(); ++i) {
    bool alone = has_two_ends(nth(laws, i));
    for (Eigen::Index k = 0; alone && k < r.c.size(); ++k) alone = !coupled(i, k) && !coupled(k, i);
    if (alone)
      alone_.push_back(i);
    else
      others_.push_back(i);
  }
}

double PlayAlone::size() const {
  double out = 0;
  for (const Eigen::Index i : alone_) out = std::max(out, std::abs(relation_.d0(i)) / std::sqrt(relation_.c(i)));
  return out;
}

SetValuedSolution PlayAlone::solution_of_others(const MatrixX& watched) const {
  if (others_.empty()) {
    SetValuedSolution none;
    none.outcome = SetValuedSolution::Outcome::solved;
    none.least = none.most = VectorX::Zero(watched.rows());
    return none;
  }
  LinearRelation rest{relation_.c(others_), relation_.d0(others_), relation_.P(others_, others_),
                      relation_.size(others_)};
  rest.size = rest.size.cwiseMax(size() * rest.c.cwiseSqrt().cwiseInverse());
  std::vector<ScalarLaw> laws;
  for (const Eigen::Index i : others_) laws.push_back(nth(laws_, i));
  return solve(rest, laws, watched(Eigen::all, others_));
}

SetValuedSolution PlayAlone::beside(const SetValuedSolution& others, const MatrixX& watched) const {
  const Eigen::Index n = relation_.c.size();
  SetValuedSolution out;
  out.outcome = others.outcome;
  out.end.assign(as_size(n), 0);
  if (others.outcome == SetValuedSolution::Outcome::overcome) {
    out.along = VectorX::Zero(n);
    for (std::size_t k = 0; k < others_.size(); ++k) out.along(others_[k]) = others.along(as_index(k));
  }
  if (others.outcome != SetValuedSolution::Outcome::solved) return out;
  out.d = out.s = VectorX::Zero(n);
  double largest = size();
  for (std::size_t k = 0; k < others_.size(); ++k) {
    const Eigen::Index i = others_[k];
    out.d(i) = others.d(as_index(k)), out.s(i) = others.s(as_index(k));
    nth(out.end, i) = others.end[k];
    largest = std::max(largest, std::abs(out.s(i)) * std::sqrt(relation_.c(i)));
  }
  std::vector<Eigen::Index> open;
  for (const Eigen::Index i : alone_) {
    const ScalarLaw& law = nth(laws_, i);
    const double s = relation_.d0(i) / relation_.c(i), over = s - law.force(law.low);
    const double most = std::max(largest / std::sqrt(relation_.c(i)), relation_.size(i));
    // Also where it is no load: a search in a deformed shape compares it with the forces there.
    out.s(i) = std::abs(s) <= no_force * most ? 0 : s;
    if (std::abs(over) <= no_load * most) {
      open.push_back(i);
      out.d(i) = law.middle;
    } else {
      nth(out.end, i) = over > 0 ? 1 : -1;
      out.d(i) = over > 0 ? law.high : law.low;
    }
  }
  out.o = out.d - relation_.c.cwiseProduct(out.s);
  const Eigen::Index before = others.loose.cols();
  out.loose = MatrixX::Zero(n, before + std::ssize(open));
  if (before > 0) out.loose(others_, Eigen::seqN(0, before)) = others.loose;
  out.least = others.least, out.most = others.most;
  for (std::size_t k = 0; k < open.size(); ++k) {
    const double half = nth(laws_, open[k]).half;
    out.loose(open[k], before + as_index(k)) = half;
    out.most += half * watched.col(open[k]).cwiseAbs();
    out.least -= half * watched.col(open[k]).cwiseAbs();
  }
  return out;
}

}  // namespace

SetValuedSolution solve_apart(const LinearRelation& r, const std::vector<ScalarLaw>& laws, const MatrixX& watched) {
  const PlayAlone alone(r, laws);
  return alone.none() ? solve(r, laws, watched) : alone.beside(alone.solution_of_others(watched), watched);
}

}  // namespace deflect
