// Each law as a function of the sum p = d + s, in units in which c = 1: of every p there is one d = R(p), with a slope
// between 0 (rigid) and 1 (no force). With s = p − R(p) the linear relation is
//   F(p) = R(p) − P (2 R(p) − p) − d0 = 0,   F' = (I − P) R' + P (I − R')
// (S. M. Robinson, Normal maps induced by linear transformations, Math. Oper. Res. 17 (1992); L. Qi, J. Sun, A
// nonsmooth version of Newton's method, Math. Program. 58 (1993)). F' is singular where a motion or a force is left
// open. Where it is regular and no law is at a kink, the solution stands alone among its neighbours; and because all
// solutions form a convex set, it is the only one.
#include "msa/base/normal_map.h"

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"

namespace deflect {
namespace {

constexpr int most_newton_steps = 25;
constexpr double rounding_of_p = 1e-15, solved_in_p = 1e-13;  // of the largest p
constexpr double least_of_the_map = 1e-6;                     // 1/|F'⁻¹|
constexpr double short_step = 0.1;
constexpr double near_a_kink = 1e-8;  // of the largest p
constexpr double another_slope = 1e-3;
constexpr double no_push = 1e-9;  // of the largest s

bool has_no_ends(const ScalarLaw& law) { return law.half > 0 && !std::isfinite(law.low); }

}  // namespace

NormalMap::NormalMap(const VectorX& c, const MatrixX& P)
    : unit_(c.cwiseSqrt()),
      P_(unit_.cwiseInverse().asDiagonal() * P * unit_.asDiagonal()),
      p_(VectorX::Zero(c.size())),
      d_(VectorX::Zero(c.size())),
      slope_(c.size()),
      factored_slope_(VectorX::Constant(c.size(), -1)),
      lu_(c.size()) {}

/// R and R' of law i.
NormalMap::AtSum NormalMap::at_sum(const ScalarLaw& law, Eigen::Index i, double p) const {
  const double u = unit_(i), d = deflection_at_sum(law, u * u, p * u, d_(i) * u);
  const bool held = d == law.low || d == law.high;
  return {d / u, held ? 0 : 1 / (1 + u * u * law.tangent(d))};
}

/// F(p).
VectorX NormalMap::lacking(const std::vector<ScalarLaw>& laws, const VectorX& d0) {
  for (Eigen::Index i = 0; i < p_.size(); ++i) {
    const AtSum at = at_sum(nth(laws, i), i, p_(i));
    d_(i) = at.d, slope_(i) = at.slope;
  }
  return d_ - P_ * (2 * d_ - p_) - d0;
}

/// Factors F' + extra I at p. Returns whether that has digits. Its size is 1 where nothing is left open, so that a
/// small one is as bad as one that is singular.
bool NormalMap::factor(double extra) {
  if (extra == factored_extra_ && slope_ == factored_slope_) return digits_;
  factored_extra_ = extra;
  factored_slope_ = slope_;
  J_ = -P_ * (2 * slope_.array() - 1).matrix().asDiagonal();
  J_.diagonal().array() += slope_.array() + extra;
  lu_.compute(J_);
  digits_ = lu_.matrixLU().diagonal().cwiseAbs().minCoeff() > least_of_the_map &&  // rcond() wants pivots
            lu_.rcond() * J_.cwiseAbs().colwise().sum().maxCoeff() > least_of_the_map;
  return digits_;
}

bool NormalMap::search(const std::vector<ScalarLaw>& laws, const VectorX& d0) {
  double before = HUGE_VAL;
  VectorX best = p_;
  for (int step = 0; step < most_newton_steps; ++step) {
    const VectorX lacks = lacking(laws, d0);
    const double now = largest(lacks), scale = std::max(largest(p_), largest(d0));
    if (!std::isfinite(now)) return false;
    if (now <= rounding_of_p * scale) return true;
    if (before <= solved_in_p * scale && now > 0.5 * before) {
      p_ = best;
      lacking(laws, d0);
      return true;
    }
    before = now;
    best = p_;
    // On the way to a state with one solution some have none, or many: a shorter step leaves them.
    if (!factor(0) && !factor(short_step)) return false;
    p_ -= lu_.solve(lacks);
  }
  return false;
}

/// Whether the state at p is the only solution, with digits.
bool NormalMap::only_solution(const std::vector<ScalarLaw>& laws, double size) {
  if (!factor(0)) return false;
  const double p = std::max(largest(p_), size), s = std::max(largest(VectorX(p_ - d_)), size);
  for (Eigen::Index i = 0; i < p_.size(); ++i) {
    for (const double aside : {-near_a_kink * p, near_a_kink * p})
      if (std::abs(at_sum(nth(laws, i), i, p_(i) + aside).slope - slope_(i)) > another_slope) return false;
    if (slope_(i) == 0 && !(std::abs(p_(i) - d_(i)) > no_push * s)) return false;
  }
  return true;
}

NormalMap::State NormalMap::state(const std::vector<ScalarLaw>& laws) const {
  State out{VectorX(p_.size()), VectorX(p_.size()), std::vector<int>(laws.size(), 0)};
  for (Eigen::Index i = 0; i < p_.size(); ++i) {
    const ScalarLaw& law = nth(laws, i);
    const double u = unit_(i), d = deflection_at_sum(law, u * u, p_(i) * u, d_(i) * u), aside = d - law.middle;
    out.d(i) = d;
    out.s(i) = slope_(i) < 0.5 ? (p_(i) - d / u) / u : law.force(d);
    if (has_no_ends(law))
      nth(out.end, i) = std::abs(aside) > law.half ? (aside > 0 ? 1 : -1) : 0;
    else if (slope_(i) == 0)
      nth(out.end, i) = d == law.high ? 1 : -1;
  }
  return out;
}

std::optional<NormalMap::State> NormalMap::solve(const VectorX& d0, const VectorX& size,
                                                 const std::vector<ScalarLaw>& laws) {
  if (laws.empty() || !search(laws, d0.cwiseQuotient(unit_)) ||
      !only_solution(laws, largest(VectorX(size.cwiseProduct(unit_))))) {
    p_.setZero();
    d_.setZero();
    return std::nullopt;
  }
  return state(laws);
}

}  // namespace deflect
