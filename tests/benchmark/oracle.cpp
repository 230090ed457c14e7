#include "tests/benchmark/oracle.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "validation/parallel/cases.h"

namespace deflect::benchmark {
namespace {

constexpr double lambdas[] = {4, 8, 16};
constexpr std::size_t directions = 6;  // drawn for an effect of several signs

}  // namespace

Oracle::Oracle(const Plan& plan, double place, double entry, std::uint64_t seed, int threads)
    : nothing_(1 - place - entry) {
  std::vector<std::vector<Case>> found(plan.signatures.size());
  parallel::for_each_case(found.size(), 1, threads, [&](std::size_t i) {
    const effects::PlacedEffect& e = plan.signatures[i].effect;
    measurement::Random random(seed + i);
    const std::vector<VectorX> all = possible_signs(*e.effect, directions, random);
    for (const VectorX& signs : all)
      for (const double lambda : lambdas)
        if (auto hidden = hidden_effect(plan, e, signs, lambda))
          found[i].push_back(
              {e.effect, 1.0 / static_cast<double>(all.size() * std::size(lambdas)), std::move(hidden->change)});
  });
  // An effect is drawn, then its place.
  std::map<const effects::Effect*, double> places, kinds[2];
  for (std::size_t i = 0; i < found.size(); ++i)
    if (!found[i].empty()) places[plan.signatures[i].effect.effect] += 1;
  for (const auto& [effect, count] : places) kinds[effect->place.has_value()][effect] = 1;
  for (std::vector<Case>& of_one : found)
    for (Case& c : of_one) {
      const bool at_place = c.effect->place.has_value();
      c.prior *= (at_place ? place : entry) / static_cast<double>(kinds[at_place].size()) / places[c.effect];
      cases_.push_back(std::move(c));
    }
}

Oracle::Answer Oracle::answer(const VectorX& residual) const {
  // Against nothing: ln p(r | change) − ln p(r | 0) = r · change − |change|²/2.
  std::vector<double> logs;
  double most = std::log(nothing_);
  for (const Case& c : cases_) {
    logs.push_back(std::log(c.prior) + residual.dot(c.change) - c.change.squaredNorm() / 2);
    most = std::max(most, logs.back());
  }
  std::map<std::string, double> by_name = {{"", std::exp(std::log(nothing_) - most)}};
  for (std::size_t i = 0; i < logs.size(); ++i) by_name[cases_[i].effect->name] += std::exp(logs[i] - most);
  std::vector<std::pair<double, std::string>> sorted;
  double total = 0;
  for (const auto& [name, weight] : by_name) {
    sorted.emplace_back(weight, name);
    total += weight;
  }
  std::sort(sorted.rbegin(), sorted.rend());
  Answer out{sorted.front().second, sorted.front().first / total, 0};
  for (double sum = 0; out.reported < sorted.size() && sum < 0.95 * total; ++out.reported)
    sum += sorted[out.reported].first;
  return out;
}

}  // namespace deflect::benchmark
