#include "tests/benchmark/oracle.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "msa/base/index.h"
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
          found[i].push_back({e.effect, lambda, 1.0 / static_cast<double>(all.size() * std::size(lambdas)),
                              std::move(hidden->change)});
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
  MatrixX changes(cases_.empty() ? 0 : cases_.front().change.size(), std::ssize(cases_));
  for (std::size_t i = 0; i < cases_.size(); ++i) changes.col(as_index(i)) = cases_[i].change;
  between_ = changes.transpose() * changes;
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

std::vector<std::string> Oracle::answer_of_two(const VectorX& residual) const {
  constexpr double none = 0.2, one = 0.6, two = 0.2, least_of_two = 7;
  const std::size_t n = cases_.size();
  std::map<const effects::Effect*, std::size_t> number;
  std::vector<double> along(n);
  std::vector<std::size_t> effect(n);
  double all = 0;
  for (std::size_t i = 0; i < n; ++i) {
    effect[i] = number.emplace(cases_[i].effect, number.size()).first->second;
    along[i] = residual.dot(cases_[i].change) - between_(as_index(i), as_index(i)) / 2;
    all += cases_[i].prior;
  }
  // Weights in two passes: the largest logarithm, then the sums by name.
  const auto each_pair = [&](const auto& take) {
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; cases_[i].lambda > least_of_two && k < i; ++k)
        if (effect[k] != effect[i] && cases_[k].lambda == cases_[i].lambda)
          take(i, k,
               std::log(cases_[i].prior * cases_[k].prior) + along[i] + along[k] - between_(as_index(i), as_index(k)));
  };
  double most = std::log(none), weight_of_pairs = 0;
  each_pair([&](std::size_t i, std::size_t k, double) { weight_of_pairs += cases_[i].prior * cases_[k].prior; });
  const double of_one = std::log(one / all), of_two = std::log(two / weight_of_pairs);
  for (std::size_t i = 0; i < n; ++i) most = std::max(most, of_one + std::log(cases_[i].prior) + along[i]);
  each_pair([&](std::size_t, std::size_t, double w) { most = std::max(most, of_two + w); });
  const Eigen::Index names = std::ssize(number);
  MatrixX weight = MatrixX::Zero(names, names);  // on the diagonal: of one effect
  for (std::size_t i = 0; i < n; ++i)
    weight(as_index(effect[i]), as_index(effect[i])) += std::exp(of_one + std::log(cases_[i].prior) + along[i] - most);
  each_pair([&](std::size_t i, std::size_t k, double w) {
    const auto [low, high] = std::minmax(effect[i], effect[k]);
    weight(as_index(low), as_index(high)) += std::exp(of_two + w - most);
  });
  Eigen::Index row = 0, column = 0;
  if (names == 0 || weight.maxCoeff(&row, &column) < std::exp(std::log(none) - most)) return {};
  const auto name_at = [&](Eigen::Index which) {
    for (const auto& [e, at] : number)
      if (as_index(at) == which) return e->name;
    return std::string();
  };
  if (row == column) return {name_at(row)};
  return {name_at(row), name_at(column)};
}

}  // namespace deflect::benchmark
