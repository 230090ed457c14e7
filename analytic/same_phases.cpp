#include "analytic/same_phases.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analytic/deflection.h"
#include "msa/base/decompositions.h"
#include "msa/base/index.h"

namespace deflect::analytic {
namespace {

constexpr int rounds = 20;
constexpr double determined = 1e-10;  // reciprocal condition from which the phases determine the offsets
constexpr double agrees = 1e-13;      // of a deflection, where a law bends
constexpr double nearly = 1e-7;       // the same of a smooth law: Newton's method squares what is left
constexpr double lost = 1e-14;        // of an offset: its rounding, from which a deflection can be a small difference

const FrictionLaw* friction_of(const SteppedLaw& l) { return std::get_if<FrictionLaw>(&l.law); }
const ClearanceLaw* clearance_of(const SteppedLaw& l) { return std::get_if<ClearanceLaw>(&l.law); }
const OneSidedLaw* one_sided_of(const SteppedLaw& l) { return std::get_if<OneSidedLaw>(&l.law); }

bool bends(const SteppedLaw& l) { return !friction_of(l) && !clearance_of(l) && !one_sided_of(l); }

int sense(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// δ of the preloaded law before any load.
double at_rest(const SteppedLaw& l) {
  if (const OneSidedLaw* one = one_sided_of(l)) return compliance(*one, l.preload) * l.preload;
  if (const ClearanceLaw* play = clearance_of(l)) return play->gap * sense(l.preload);
  return l.preload == 0 || friction_of(l) ? 0 : analytic::deflection(l.law, l.preload);
}

/// The part of its deflection to which two rounds must agree on where its tangent is taken.
double agreement(const SteppedLaw& l) {
  const bool smooth = std::holds_alternative<HertzPointLaw>(l.law) || std::holds_alternative<HertzLineLaw>(l.law) ||
                      std::holds_alternative<HertzLineBulkLaw>(l.law) || std::holds_alternative<PowerLaw>(l.law) ||
                      std::holds_alternative<HardeningLaw>(l.law);
  return smooth ? nearly : agrees;
}

double slip_of(const FrictionLaw& l, const std::vector<double>& slips) {
  const std::size_t n = as_size(l.number);
  return l.number >= 0 && n < slips.size() ? slips[n] : 0;
}

double limit_of(const SteppedLaw& l, const VectorX& s) {
  const FrictionLaw& friction = *friction_of(l);
  return friction.force + (l.load >= 0 ? friction.share * std::abs(s(l.load)) : 0);
}

}  // namespace

SamePhases::SamePhases(std::vector<SteppedLaw> laws, Imposed imposed)
    : laws_(std::move(laws)),
      imposed_(std::move(imposed)),
      n_(std::ssize(laws_)),
      phases_(laws_.size()),
      root_(imposed_.c.cwiseSqrt()) {
  for (const SteppedLaw& l : laws_) bends_ = bends_ || bends(l);
}

SamePhases::Line SamePhases::line(Eigen::Index i, const std::vector<double>& slips) const {
  const SteppedLaw& l = nth(laws_, i);
  const LawPhase& in = nth(phases_, i);
  const double P = l.preload, c = imposed_.c(i);
  if (const ClearanceLaw* play = clearance_of(l))
    return in.phase == 0 ? Line{0, c, 0, -c * P} : Line{1, 0, 0, in.phase * play->gap - at_rest(l)};
  if (const OneSidedLaw* one = one_sided_of(l)) {
    const double own = compliance(*one, in.phase);
    return {1, -own, 0, own * P - at_rest(l)};
  }
  if (const FrictionLaw* f = friction_of(l)) {
    if (in.phase == 0) return {1, -1 / f->stiffness, 0, slip_of(*f, slips)};
    const double grows = l.load >= 0 ? in.phase * in.of_load * f->share : 0;
    return {0, c, -c * grows, c * (in.phase * f->force - P)};
  }
  const double there = in.d + at_rest(l), force = force_of(l.law, there), own = analytic::compliance(l.law, force);
  return {1, -own, 0, in.d - own * (force - P)};
}

SamePhases::LawPhase SamePhases::phase(Eigen::Index i, const VectorX& d, const VectorX& s,
                                       const std::vector<double>& slips) const {
  const SteppedLaw& l = nth(laws_, i);
  LawPhase in = nth(phases_, i);
  const double f = s(i) + l.preload;
  if (const ClearanceLaw* play = clearance_of(l)) {
    const double there = d(i) + at_rest(l);
    if (in.phase == 0)
      in.phase = std::abs(there) > play->gap ? sense(there) : 0;
    else if (in.phase * f <= 0)
      in.phase = 0;
  } else if (one_sided_of(l)) {
    if (in.phase * f <= 0) in.phase = f < 0 ? -1 : 1;
  } else if (const FrictionLaw* friction = friction_of(l)) {
    const double limit = limit_of(l, s);
    if (in.phase == 0)
      in.phase = std::abs(f) > limit ? sense(f) : 0;
    else if (in.phase * (friction->stiffness * (d(i) - slip_of(*friction, slips)) + l.preload) < limit)
      in.phase = 0;
    if (l.load >= 0 && in.of_load * s(l.load) < 0) in.of_load = -in.of_load;
  } else {
    in.d = d(i);
  }
  return in;
}

bool SamePhases::factorise(const std::vector<Line>& lines) {
  if (!bends_ && factorised_ == phases_) return true;
  MatrixX A(n_, n_);
  for (Eigen::Index i = 0; i < n_; ++i) {
    const Line& line = nth(lines, i);
    A.row(i) = -(line.of_d * imposed_.c(i) + line.of_s) * imposed_.S.row(i);
    A(i, i) += line.of_d;
    if (const int load = nth(laws_, i).load; load >= 0) A.row(i) -= line.of_load * imposed_.S.row(load);
  }
  A = root_.cwiseInverse().asDiagonal() * A * root_.asDiagonal();
  factorised_.clear();
  if (!A.allFinite()) return false;
  lu_.compute(A);
  determined_.reset();
  factorised_ = phases_;
  return true;
}

std::optional<BalancedSteps> SamePhases::after(const VectorX& f0, const std::vector<double>& slips) {
  if (!known_) return std::nullopt;
  const std::vector<LawPhase> before = phases_;
  std::vector<Line> lines(laws_.size());
  for (int round = 0; round < rounds; ++round) {
    VectorX right(n_);
    for (Eigen::Index i = 0; i < n_; ++i) {
      const Line line = nth(lines, i) = this->line(i, slips);
      right(i) = line.is - (line.of_d * imposed_.c(i) + line.of_s) * f0(i);
      if (const int load = nth(laws_, i).load; load >= 0) right(i) -= line.of_load * f0(load);
    }
    if (!factorise(lines)) break;
    const VectorX o = root_.cwiseProduct(lu_.solve(right.cwiseQuotient(root_))), s = f0 - imposed_.S * o,
                  d = o + imposed_.c.cwiseProduct(s);
    if (!o.allFinite()) break;
    bool stays = true;
    std::vector<LawPhase> next(laws_.size());
    for (Eigen::Index i = 0; i < n_; ++i) {
      const LawPhase &now = nth(phases_, i), &then = nth(next, i) = phase(i, d, s, slips);
      stays = stays && then.phase == now.phase && then.of_load == now.of_load &&
              std::abs(then.d - now.d) <= std::max(agreement(nth(laws_, i)) * std::abs(then.d), lost * std::abs(o(i)));
    }
    if (!stays) {
      phases_ = std::move(next);
      continue;
    }
    if (!determined_) determined_ = reciprocal_condition(lu_) > determined;
    if (!*determined_) break;
    BalancedSteps out;
    out.converged = true;
    out.offsets = o;
    for (Eigen::Index i = 0; i < n_; ++i) {
      const FrictionLaw* friction = friction_of(nth(laws_, i));
      if (!friction) continue;
      const auto n = as_size(std::max(friction->number, 0));
      out.slips.resize(std::max(out.slips.size(), n + 1));
      const int slides = nth(phases_, i).phase;
      const double known = slides * limit_of(nth(laws_, i), s) - nth(laws_, i).preload;
      out.slips[n] = slides == 0 ? slip_of(*friction, slips) : d(i) - known / friction->stiffness;
    }
    return out;
  }
  phases_ = before;
  return std::nullopt;
}

void SamePhases::remember(const VectorX& f0, const std::vector<double>& slips, const BalancedSteps& found) {
  known_ = false;
  if (!found.converged || found.offsets.size() != n_) return;
  const VectorX s = f0 - imposed_.S * found.offsets, d = found.offsets + imposed_.c.cwiseProduct(s);
  const double no_force = 1e-9;  // of the largest
  for (Eigen::Index i = 0; i < n_; ++i) {
    const SteppedLaw& l = nth(laws_, i);
    if (remembers(l.law)) return;
    LawPhase& in = nth(phases_, i);
    const double f = s(i) + l.preload;
    in = {};
    if (clearance_of(l))
      in.phase = std::abs(f) > no_force * std::abs(f0(i)) ? sense(f) : 0;
    else if (one_sided_of(l))
      in.phase = f < 0 ? -1 : 1;
    else if (const FrictionLaw* friction = friction_of(l))
      in.phase = slip_of(*friction, found.slips) != slip_of(*friction, slips) ? (f < 0 ? -1 : 1) : 0;
    else
      in.d = d(i);
    if (l.load >= 0) in.of_load = s(l.load) < 0 ? -1 : 1;
  }
  known_ = true;
}

}  // namespace deflect::analytic
