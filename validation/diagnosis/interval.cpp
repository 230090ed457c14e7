#include "validation/diagnosis/interval.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "msa/base/index.h"
#include "validation/diagnosis/fit_problem.h"
#include "validation/diagnosis/signatures.h"
#include "validation/parallel/cases.h"
#include "validation/statistics/columns.h"

namespace deflect::diagnosis {
namespace {

constexpr double quantile = 1.959964;  // of √(χ² − χ²(best)), which is linear in the coordinate of a parabola
constexpr double near_enough = 0.05;   // to it
constexpr double settled = 0.02;       // that the other parameters may still gain in χ²
constexpr int steps = 16, inner_steps = 8;

/// χ² along the coordinate of one parameter.
class Profile {
 public:
  Profile(const FitProblem& problem, const Fit& fit, Eigen::Index at)
      : problem_(problem), fit_(fit), at_(at), best_(problem.coordinates(fit.values)) {
    for (Eigen::Index i = 0; i < best_.size(); ++i)
      if (i != at) others_.push_back(i);
    along_ = statistics::orthonormal(fit.signature(Eigen::all, others_));
    const double variance = fit.covariance(at, at);
    sd_ = std::sqrt(std::max(0.0, variance));
    slope_ = variance > 0 ? VectorX(fit.covariance(others_, std::vector<Eigen::Index>{at}) / variance)
                          : VectorX::Zero(std::ssize(others_));
  }

  /// sense: +1 or −1.
  double limit(double sense) const {
    const effects::EffectParameter& p = *nth(problem_.parameters(), at_);
    const double from = best_(at_), end = coordinate(p, sense > 0 ? p.high : p.low);
    const double range = std::abs(coordinate(p, p.high) - coordinate(p, p.low));
    const auto cut = [&](double x) { return sense * (x - end) > 0 ? end : x; };
    Point inside{from, 0, best_(others_)};
    std::optional<Point> outside;
    double x = cut(from + sense * (sd_ > 1e-9 * range ? quantile * sd_ : 0.05 * range));
    for (int i = 0; i < steps && x != from; ++i) {
      const Point here = at(x, inside);
      if (std::abs(here.s - quantile) < near_enough) return x;
      if (here.s < quantile) {
        if (x == end) return end;
        inside = here;
      } else {
        outside = here;
      }
      if (!outside) {
        x = cut(from + (x - from) * std::clamp(quantile / std::max(here.s, 1e-3), 1.2, 4.0));
        continue;
      }
      const double width = outside->x - inside.x, share = (quantile - inside.s) / (outside->s - inside.s);
      if (std::abs(width) < near_enough / quantile * std::abs(outside->x - from)) break;  // a step of χ²
      x = inside.x + std::clamp(share, 0.1, 0.9) * width;
    }
    return inside.x;
  }

 private:
  struct Point {
    double x = 0, s = 0;  ///< s = √(χ² − χ²(best)), at most four times the quantile
    VectorX others;
  };

  /// Begins with the others of a point nearby.
  Point at(double x, const Point& near) const {
    VectorX all = best_;
    all(at_) = x;
    all(others_) = near.others + (x - near.x) * slope_;
    all = problem_.coordinates(problem_.values(all));
    VectorX residual = problem_.residual_or_wall(all);
    double chi2 = residual.squaredNorm();
    if (!others_.empty() && (along_.transpose() * residual).squaredNorm() > settled) {
      VectorX moved = all;
      moved(others_) = minimised({&problem_, all, others_}, VectorX(all(others_)), inner_steps);
      if (moved.allFinite()) {
        moved = problem_.coordinates(problem_.values(moved));
        if (const double less = problem_.residual_or_wall(moved).squaredNorm(); less < chi2) chi2 = less, all = moved;
      }
    }
    return {x, std::min(std::sqrt(std::max(0.0, chi2 - fit_.chi2)), 4 * quantile), all(others_)};
  }

  const FitProblem& problem_;
  const Fit& fit_;
  Eigen::Index at_;
  VectorX best_, slope_;
  std::vector<Eigen::Index> others_;
  MatrixX along_;
  double sd_ = 0;
};

/// By parameter, whether at its upper bound the part has let go.
std::vector<char> gone_above(const Hypothesis& h) {
  std::vector<char> out;
  for (const effects::PlacedEffect& e : h)
    for (const effects::EffectParameter& p : e.effect->parameters) out.push_back(p.vanishes == 0 && lets_go(*e.effect));
  return out;
}

}  // namespace

Fit with_intervals(const Observations& o, const Hypothesis& h, Fit f, int threads) {
  f.limits.clear();
  if (!f.found || h.empty()) return f;
  FitProblem problem(o, h);
  problem.stand_at(problem.coordinates(f.values));
  std::vector<double> ends(2 * as_size(f.values.size()));
  parallel::for_each_case(ends.size(), 1, threads, [&](std::size_t k) {
    const auto i = as_index(k / 2);
    ends[k] = value_at(*nth(problem.parameters(), i), Profile(problem, f, i).limit(k % 2 == 0 ? -1 : 1));
  });
  const std::vector<char> gone = gone_above(h);
  for (std::size_t k = 0; k < ends.size(); k += 2) {
    const bool open = gone[k / 2] && ends[k + 1] > (1 - 1e-9) * nth(problem.parameters(), as_index(k / 2))->high;
    f.limits.emplace_back(ends[k], open ? std::numeric_limits<double>::infinity() : ends[k + 1]);
  }
  return f;
}

Fit weighed_for_itself(const Observations& o, const Hypothesis& h, const Fit& f, int threads) {
  if (h.empty()) return f;
  const Observations own = o.weighed_for(subject_with(o, h, f.values));
  Fit again = fit_of_all(own, h, f.values);
  return again.found ? with_intervals(own, h, std::move(again), threads) : with_intervals(o, h, f, threads);
}

bool says_nothing_of_last(const Fit& f) {
  constexpr double deviations = 10;  // a step of size 1 is a large one
  const Eigen::Index last = f.values.size() - 1;
  return f.found && last >= 0 && !(f.covariance(last, last) < deviations * deviations);
}

std::pair<double, double> interval95(const Hypothesis& h, const Fit& f, std::size_t i) {
  if (!f.limits.empty()) return f.limits.at(i);
  const effects::EffectParameter& p = *parameters_of(h).at(i);
  const auto at = as_index(i);
  const double x = coordinate(p, f.values(at)), half = quantile * std::sqrt(std::max(0.0, f.covariance(at, at)));
  return {value_at(p, x - half), value_at(p, x + half)};
}

}  // namespace deflect::diagnosis
