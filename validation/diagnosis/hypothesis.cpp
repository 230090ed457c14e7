#include "validation/diagnosis/hypothesis.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/diagnosis/fit_problem.h"
#include "validation/effects/law_of_effect.h"
#include "validation/parallel/cases.h"

namespace deflect::diagnosis {
namespace {

/// Starts of the last effect's parameters: over the bounds where its size is searched on a logarithmic scale, where
/// signs are open the value at which it vanishes.
std::vector<VectorX> starts(const effects::PlacedEffect& e) {
  const std::vector<effects::EffectParameter>& all = e.effect->parameters;
  std::vector<VectorX> out = {VectorX(std::ssize(all))};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const effects::EffectParameter& p = all[i];
    std::vector<double> tries;
    const bool from_nothing = p.vanishes && p.low < *p.vanishes && *p.vanishes < p.high;
    if (from_nothing && !p.log)
      tries = {*p.vanishes};
    else if (from_nothing) {
      tries = {*p.vanishes * 1.02, *p.vanishes / 1.02};
      // Far from 1 a factor's effect saturates: a search that jumps there does not come back.
      for (const double share : {0.3, 0.05, 4.0})
        if (const double far = share * *p.vanishes; 2 * p.low < far && 2 * far < p.high) tries.push_back(far);
    } else if (p.log) {
      const int count = all.size() == 1 ? 9 : p.vanishes ? 7 : 3;
      const double low = std::max(std::log(p.low), std::log(p.start) - 9),
                   high = std::min(std::log(p.high), std::log(p.start) + 9);
      for (int k = 0; k < count; ++k) tries.push_back(std::exp(low + (high - low) * (k + 0.5) / count));
      tries.push_back(p.start);
    } else
      tries = {p.start};  // others: elsewhere()
    std::vector<VectorX> more;
    for (const VectorX& begun : out)
      for (const double value : tries) {
        more.push_back(begun);
        more.back()(as_index(i)) = value;
      }
    out = std::move(more);
  }
  return out;
}

/// The same start with each state that nothing fixes (how friction began) far up and far down its range.
std::vector<VectorX> elsewhere(const effects::PlacedEffect& e, const VectorX& start) {
  std::vector<VectorX> out;
  for (std::size_t i = 0; i < e.effect->parameters.size(); ++i) {
    const effects::EffectParameter& p = e.effect->parameters[i];
    if (p.log || (p.vanishes && p.low < *p.vanishes && *p.vanishes < p.high)) continue;
    for (const double share : {0.9, 0.1}) {
      out.push_back(start);
      out.back()(as_index(i)) = p.low + share * (p.high - p.low);
    }
  }
  return out;
}

}  // namespace

std::string name_of(const effects::PlacedEffect& p) {
  return p.leg ? fmt::format("{} ({})", p.effect->name, effects::site_of(p)) : p.effect->name;
}

std::vector<const effects::EffectParameter*> parameters_of(const Hypothesis& h) {
  std::vector<const effects::EffectParameter*> out;
  for (const effects::PlacedEffect& e : h)
    for (const effects::EffectParameter& p : e.effect->parameters) out.push_back(&p);
  return out;
}

bool is_shaped(const effects::PlacedEffect& e) {
  const std::vector<effects::EffectParameter>& all = e.effect->parameters;
  return std::any_of(all.begin(), all.end(), [](const effects::EffectParameter& p) { return !p.vanishes; });
}

bool one_sided(const effects::PlacedEffect& e) {
  if (e.effect->parameters.size() != 1) return false;
  const effects::EffectParameter& p = e.effect->parameters.front();
  return p.vanishes && (*p.vanishes <= p.low || *p.vanishes >= p.high);
}

namespace {

struct Start {
  VectorX x;
  double chi2 = INFINITY;
};

/// Without those that cannot be predicted.
void deepest_first(std::vector<Start>& all) {
  std::erase_if(all, [](const Start& s) { return !std::isfinite(s.chi2); });
  std::stable_sort(all.begin(), all.end(), [](const Start& a, const Start& b) { return a.chi2 < b.chi2; });
}

/// Values that were fitted to an end of their range say little there: where others join them a search may not leave it.
/// The same with their starts in their place; nothing where none stands at an end.
std::optional<VectorX> off_the_ends(const FitProblem& problem, const VectorX& from) {
  VectorX out = from;
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    const effects::EffectParameter& p = *nth(problem.parameters(), i);
    if (!p.vanishes && (from(i) <= p.low || from(i) >= p.high)) out(i) = p.start;
  }
  if (out == from) return std::nullopt;
  return out;
}

/// χ² at each; those that cannot be predicted are left out. `why`: what the first of these met with.
void look_at(std::vector<Start>& all, const FitProblem& problem, std::string& why, int threads) {
  std::vector<std::string> reasons(all.size());
  parallel::for_each_case(all.size(), 1, threads, [&](std::size_t i) {
    if (const auto r = problem.residual(all[i].x, &reasons[i])) all[i].chi2 = r->squaredNorm();
  });
  const auto first = std::find_if(reasons.begin(), reasons.end(), [](const std::string& r) { return !r.empty(); });
  if (first != reasons.end() && why.empty()) why = *first;
  deepest_first(all);
}

/// The best of the last effect's values, behind those of the effects before; so many at most, the best first.
/// `why`: what the first that cannot be predicted met with.
std::vector<Start> best_starts(const FitProblem& problem, const std::vector<VectorX>& tails, const VectorX& from,
                               std::size_t count, std::string& why, int threads) {
  std::vector<Start> all;
  std::vector<VectorX> heads = {from};
  if (const auto moved = off_the_ends(problem, from)) heads.push_back(*moved);
  for (const VectorX& head : heads)
    for (const VectorX& tail : tails) {
      VectorX values(head.size() + tail.size());
      values << head, tail;
      all.push_back({problem.coordinates(values)});
    }
  look_at(all, problem, why, threads);
  if (all.size() > count) all.resize(count);
  return all;
}

/// As many starts, the best of these and of the same with other states at the beginning of this effect, whose values
/// begin at `first`.
void look_elsewhere(std::vector<Start>& begun, const FitProblem& problem, const effects::PlacedEffect& e,
                    Eigen::Index first, int threads) {
  const std::size_t count = begun.size();
  const auto own = std::ssize(e.effect->parameters);
  std::vector<Start> more;
  for (const Start& start : begun) {
    VectorX values = problem.values(start.x);
    for (const VectorX& other : elsewhere(e, VectorX(values.segment(first, own)))) {
      values.segment(first, own) = other;
      more.push_back({problem.coordinates(values)});
    }
  }
  std::string why;
  look_at(more, problem, why, threads);
  begun.insert(begun.end(), more.begin(), more.end());
  deepest_first(begun);
  if (begun.size() > count) begun.resize(count);
}

/// Beside friction, χ² has valleys besides the deepest one: a slip comes before or after a turn of the load.
bool may_have_valleys(const effects::PlacedEffect& e) { return is_shaped(e) && e.effect->parameters.size() > 1; }
constexpr std::size_t valleys = 5, followed = 2;
constexpr int few_steps = 8, all_steps = 40, most_shapes = 4;

FreeResidual of_all(const FitProblem& problem, const VectorX& x) {
  std::vector<Eigen::Index> all(as_size(x.size()));
  std::iota(all.begin(), all.end(), 0);
  return {&problem, x, all};
}

/// Some steps of a search, within the bounds.
Start nearer(const FitProblem& problem, Start start, int evaluations) {
  const VectorX x = minimised(of_all(problem, start.x), start.x, evaluations);
  if (!x.allFinite()) return start;
  const VectorX inside = problem.coordinates(problem.values(x));
  const double chi2 = problem.residual_or_wall(inside).squaredNorm();
  if (chi2 <= start.chi2) start = {inside, chi2};
  return start;
}

Fit search_from(const FitProblem& problem, const Start& start) {
  const VectorX best = start.x.size() > 0 ? nearer(problem, start, all_steps).x : start.x;
  FreeResidual all = of_all(problem, best);
  Fit out;
  out.values = problem.values(best);
  all(best, out.residual);
  all.df(best, out.signature);
  out.chi2 = out.residual.squaredNorm();
  if (best.size() > 0) {
    // What the data say nothing of is left open by far more than its bounds: a step of size 1 is a large one.
    constexpr double next_to_nothing = 1e-8;
    const MatrixX information = out.signature.transpose() * out.signature;
    out.covariance = (information + next_to_nothing * MatrixX::Identity(best.size(), best.size())).inverse();
  }
  out.found = true;
  return out;
}

/// Follows several valleys for a few steps, which tell most of their depths, and the deepest of them to the bottom.
Fit deepest(const FitProblem& problem, std::vector<Start> begun, int threads) {
  if (begun.size() > followed) {
    parallel::for_each_case(begun.size(), 1, threads,
                            [&](std::size_t i) { begun[i] = nearer(problem, begun[i], few_steps); });
    deepest_first(begun);
    begun.resize(followed);
  }
  std::vector<Fit> ends(begun.size());
  parallel::for_each_case(begun.size(), 1, threads, [&](std::size_t i) { ends[i] = search_from(problem, begun[i]); });
  Fit best;
  for (Fit& each : ends)
    if (!best.found || each.chi2 < best.chi2) best = std::move(each);
  return best;
}

/// Whether the last effect has one parameter, on a logarithmic scale, and is so large that its size no longer shows: a
/// search that began where it was small may have jumped over the size that explains most.
bool is_saturated(const FitProblem& problem, const Hypothesis& h, const Fit& found) {
  constexpr double hardly = 0.1, much = 1;  // of σ: by a step of size 1, and by the effect as a whole
  const std::vector<effects::EffectParameter>& own = h.back().effect->parameters;
  if (!found.found || own.size() != 1 || !own.front().log || !own.front().vanishes) return false;
  if (found.signature.rightCols<1>().norm() > hardly) return false;
  VectorX without = found.values;
  without.tail<1>()(0) = std::clamp(*own.front().vanishes, own.front().low, own.front().high);
  const auto nothing = problem.residual(problem.coordinates(without));
  return !nothing || (*nothing - found.residual).norm() > much;
}

/// The fit with the deformed shape that belongs to its values.
Fit in_own_shape(FitProblem& problem, Fit found) {
  for (int pass = 0; pass < most_shapes; ++pass) {
    const VectorX x = problem.coordinates(found.values);
    if (!(problem.stand_at(x) > known_shape)) break;
    found = search_from(problem, {x, problem.residual_or_wall(x).squaredNorm()});
  }
  return found;
}

}  // namespace

Fit not_found(std::string why) {
  Fit out;
  out.why = std::move(why);
  return out;
}

Fit fit(const Observations& o, const Hypothesis& h, const VectorX& from, const std::optional<VectorX>& guess,
        int threads) {
  const auto fitted = outcome_of([&] {
    FitProblem problem(o, h);
    VectorX first(from.size() + std::ssize(h.back().effect->parameters));
    first << from, guess ? *guess : effects::start_values(*h.back().effect);
    problem.stand_at(problem.coordinates(first));
    std::string why;
    Fit found;
    if (guess) found = deepest(problem, best_starts(problem, {*guess}, from, 1, why, 1), threads);
    if (!found.found || is_saturated(problem, h, found)) {
      std::vector<Start> begun = best_starts(problem, starts(h.back()), from, valleys, why, threads);
      look_elsewhere(begun, problem, h.back(), from.size(), threads);
      if (begun.size() > 1 && !(may_have_valleys(h.back()) && problem.has_history(begun.front().x))) begun.resize(1);
      Fit other = deepest(problem, std::move(begun), threads);
      if (other.found && !(found.found && found.chi2 <= other.chi2)) found = std::move(other);
    }
    return found.found ? in_own_shape(problem, std::move(found)) : not_found(why);
  });
  return fitted ? *fitted : not_found(fitted.why);  // the effects may not go together in this subject
}

Fit searched_again(const Observations& o, const Hypothesis& h, Fit found, int threads) {
  FitProblem problem(o, h);
  problem.stand_at(problem.coordinates(found.values));
  Eigen::Index first = 0;
  for (const effects::PlacedEffect& e : h) {
    const auto own = std::ssize(e.effect->parameters);
    if (h.size() > 1 && may_have_valleys(e) && problem.has_history(problem.coordinates(found.values))) {
      const std::vector<VectorX> tries = starts(e);
      std::vector<Start> begun;
      for (const VectorX& own_values : tries) {
        VectorX values = found.values;
        values.segment(first, own) = own_values;
        begun.push_back({problem.coordinates(values)});
      }
      std::string why;
      look_at(begun, problem, why, threads);
      begun.resize(std::min(begun.size(), valleys));
      look_elsewhere(begun, problem, e, first, threads);
      if (Fit again = deepest(problem, std::move(begun), threads); again.found && again.chi2 < found.chi2)
        found = std::move(again);
    }
    first += own;
  }
  return found;
}

Fit fit_of_all(const Observations& o, const Hypothesis& h, const VectorX& values) {
  if (!h.empty()) {
    const auto own = std::ssize(h.back().effect->parameters);
    return fit(o, h, values.head(values.size() - own), VectorX(values.tail(own)));
  }
  Fit null;
  null.values = VectorX(0);
  null.residual = o.null_residual();
  null.chi2 = null.residual.squaredNorm();
  null.signature.resize(null.residual.size(), 0);
  null.found = true;
  return null;
}

std::pair<Hypothesis, VectorX> without(Hypothesis h, const VectorX& values, std::size_t i) {
  const auto sizes = [&](std::size_t first, std::size_t last) {
    std::size_t sum = 0;
    for (std::size_t k = first; k < last; ++k) sum += h[k].effect->parameters.size();
    return as_index(sum);
  };
  const Eigen::Index before = sizes(0, i), after = sizes(i + 1, h.size());
  VectorX rest(before + after);
  rest << values.head(before), values.tail(after);
  h.erase(h.begin() + as_index(i));
  return {std::move(h), std::move(rest)};
}

subject::Subject subject_with(const Observations& o, const Hypothesis& h, const VectorX& values) {
  return h.empty() ? o.subject() : effects::PreparedEffects(o.subject(), h)(values);
}

double log_likelihood(const Observations& o, const Hypothesis& h, const VectorX& values) {
  return o.log_likelihood_of_scales(subject_with(o, h, values), {1}).front();
}

namespace {

bool yields_to_one_sense(const effects::Effect& e) {
  const std::optional<Law> law = effects::law_in_series(e);
  return law && std::holds_alternative<OneSidedLaw>(*law);
}

}  // namespace

bool wants_more_than_there_can_be(const Hypothesis& h, const Fit& f) {
  const std::vector<effects::EffectParameter>& own = h.back().effect->parameters;
  if (own.size() != 1 || !f.found) return false;
  const effects::EffectParameter& p = own.front();
  const double x = coordinate(p, f.values(f.values.size() - 1));
  // A factor that runs to nothing is a part that is missing; a support that yields without end to one sense lets go.
  const auto has_a_meaning = [&](double bound) {
    return p.log && (bound < 1e-5 * p.start || (bound > 1e5 * p.start && yields_to_one_sense(*h.back().effect)));
  };
  for (const double bound : {p.low, p.high})
    if (p.vanishes != bound && !has_a_meaning(bound) && std::abs(x - coordinate(p, bound)) < 1e-3) return true;
  return false;
}

bool runs_to_a_bound(const Hypothesis& h, const Fit& f) {
  const std::vector<effects::EffectParameter>& own = h.back().effect->parameters;
  if (own.size() < 2 || !f.found) return false;
  const Eigen::Index first = f.values.size() - std::ssize(own);
  for (std::size_t i = 0; i < own.size(); ++i) {
    const double x = coordinate(own[i], f.values(first + as_index(i)));
    const double low = coordinate(own[i], own[i].low), high = coordinate(own[i], own[i].high);
    if (std::min(x - low, high - x) < 1e-3 * (high - low)) return true;
  }
  return false;
}

bool turns_as_it_grows(const effects::Effect& e) {
  if (!e.place || e.parameters.size() != 1) return false;
  const effects::EffectParameter& p = e.parameters.front();
  return p.log && p.vanishes && p.low < *p.vanishes && *p.vanishes < p.high && !e.place->one_stiffness;
}

bool at_one_place(const effects::PlacedEffect& a, const effects::PlacedEffect& b) {
  const std::optional<subject::Place>&at = a.effect->place, &other = b.effect->place;
  return at && other && a.leg == b.leg && a.effect->scope == b.effect->scope &&
         subject::id_of(*at) == subject::id_of(*other);
}

bool is_wider(const effects::PlacedEffect& wide, const effects::PlacedEffect& one) {
  const std::optional<subject::Place>&group = wide.effect->place, &place = one.effect->place;
  if (!group || !place || same(wide, one) || wide.leg != one.leg || law_of(wide) != law_of(one)) return false;
  const auto has = [&](const std::string& path, const std::vector<std::size_t>& freedoms) {
    return (group->path == path && group->freedoms == freedoms) ||
           std::any_of(group->others.begin(), group->others.end(),
                       [&](const subject::OtherPart& o) { return o.path == path && o.freedoms == freedoms; });
  };
  return has(place->path, place->freedoms) &&
         std::all_of(place->others.begin(), place->others.end(),
                     [&](const subject::OtherPart& o) { return has(o.path, o.freedoms); });
}

}  // namespace deflect::diagnosis
