#include "validation/diagnosis/ties.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "msa/base/index.h"
#include "validation/diagnosis/fit_problem.h"
#include "validation/statistics/evidence.h"

namespace deflect::diagnosis {
namespace {

constexpr double sure = 0.9, together = 0.95;  // probabilities: of one alone; of those that tie
constexpr double far_rarer = 1.5;              // ln of the odds before any reading, of two that are one to these data
constexpr double out_of_the_tie = -1e6;
constexpr double as_good = 1;  // of χ²

/// Whether these data leave open one of the parameters of a law that bends: of a friction that never slips its force.
bool leaves_one_open(const Candidate& c) {
  constexpr double deviations = 10;  // a step of size 1 is a large one
  const auto own = std::ssize(c.added().effect->parameters);
  return is_shaped(c.added()) && c.fit.covariance.rows() >= own &&
         c.fit.covariance.diagonal().tail(own).maxCoeff() > deviations * deviations;
}

std::optional<VectorX> left_by(const Candidate& c, const VectorX& values, const Observations& o) {
  const FitProblem problem(o, c.hypothesis);
  return problem.residual(problem.coordinates(values));
}

/// What is left where one of its own parameters, on a logarithmic scale, stands at a bound, as far as it may stand
/// there: that of a friction that need not slip. Its derivative only says where it would begin to.
std::vector<VectorX> left_at_bounds(const Candidate& c, const Observations& o) {
  std::vector<VectorX> out;
  const auto fitted = left_by(c, c.fit.values, o);
  const std::vector<effects::EffectParameter>& own = c.added().effect->parameters;
  for (std::size_t i = 0; i < own.size() && fitted; ++i)
    for (const double bound : {own[i].low, own[i].high}) {
      if (!own[i].log) continue;
      VectorX values = c.fit.values;
      values(values.size() - std::ssize(own) + as_index(i)) = bound;
      auto there = left_by(c, values, o);
      if (there && there->squaredNorm() < fitted->squaredNorm() + as_good) out.push_back(std::move(*there));
    }
  return out;
}

/// Nor is a common cause another name of a law that is less likely, because it has fewer parameters.
bool does_as_well(const Candidate& simpler, const Candidate& c) {
  const auto parameters = [](const Candidate& x) { return x.added().effect->parameters.size(); };
  return simpler.fit.found && c.fit.found && parameters(simpler) < parameters(c) &&
         simpler.fit.chi2 < c.fit.chi2 + as_good && simpler.log_odds >= c.log_odds;
}

/// Whether it is a simpler candidate under another name: it stands at a bound of its own or leaves one of its
/// parameters open, and one with fewer parameters does as well; or it may be that one.
bool is_another(const Candidate& c, const std::vector<Candidate>& all, const Observations& o) {
  const auto does = [&](const Candidate& other) { return does_as_well(other, c); };
  if (std::none_of(all.begin(), all.end(), does)) return false;
  return runs_to_a_bound(c.hypothesis, c.fit) || leaves_one_open(c) || simpler_form(c, all, o);
}

/// Whether a member of its own class stands for it: these data cannot tell the two apart, and before any reading this
/// one is far rarer, as a law at a place beside an entry that does the same.
bool is_stood_for(const Candidate& c, const Tie& group) {
  return std::any_of(group.rivals.begin(), group.rivals.end(), [&](const Candidate& r) {
    return r.class_log_odds == c.class_log_odds && std::abs(r.fit.chi2 - c.fit.chi2) < as_good &&
           r.log_odds > c.log_odds + far_rarer;
  });
}

}  // namespace

bool Tie::holds(const Candidate& c) const {
  return std::find(names.begin(), names.end(), c.added().effect->name) != names.end();
}

void Tie::put_first(const Candidate& own) {
  if (!holds(own)) {
    names.push_back(own.added().effect->name);
    rivals.push_back(own);
  }
  const auto k = std::find(names.begin(), names.end(), own.added().effect->name) - names.begin();
  std::rotate(names.begin(), names.begin() + k, names.begin() + k + 1);
  std::rotate(rivals.begin(), rivals.begin() + k, rivals.begin() + k + 1);
}

const Candidate* simpler_form(const Candidate& c, const std::vector<Candidate>& all, const Observations& o) {
  std::vector<const Candidate*> simpler;
  for (const Candidate& other : all)
    if (does_as_well(other, c)) simpler.push_back(&other);
  const std::vector<VectorX> at_bounds = simpler.empty() ? std::vector<VectorX>() : left_at_bounds(c, o);
  const Candidate* out = nullptr;
  for (const Candidate* other : simpler) {
    if (at_bounds.empty() || (out && out->log_odds >= other->log_odds)) continue;
    const auto left = left_by(*other, other->fit.values, o);
    const auto is_left = [&](const VectorX& there) { return left && (there - *left).squaredNorm() < as_good; };
    if (std::any_of(at_bounds.begin(), at_bounds.end(), is_left)) out = other;
  }
  return out;
}

Tie tie_of(const std::vector<Candidate>& all, const Observations& o) {
  std::vector<double> log_odds;
  for (const Candidate& c : all)
    log_odds.push_back(c.fit.found && !is_another(c, all, o) ? c.log_odds : out_of_the_tie);
  const std::vector<double> among = statistics::normalised(log_odds);
  std::vector<std::size_t> by(all.size());
  for (std::size_t i = 0; i < by.size(); ++i) by[i] = i;
  std::stable_sort(by.begin(), by.end(), [&](std::size_t a, std::size_t b) { return among[a] > among[b]; });
  if (by.empty() || among[by.front()] > sure) return {};
  Tie group;
  double sum = 0;
  for (const std::size_t i : by) {
    const std::string& name = all[i].added().effect->name;
    if (std::find(group.names.begin(), group.names.end(), name) == group.names.end() && !is_stood_for(all[i], group)) {
      group.names.push_back(name);
      group.rivals.push_back(all[i]);
      group.rivals.back().probability = among[i];
    }
    if ((sum += among[i]) > together) break;
  }
  return group.names.size() > 1 ? group : Tie{};
}

}  // namespace deflect::diagnosis
