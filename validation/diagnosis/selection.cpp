#include "validation/diagnosis/selection.h"

#include <algorithm>
#include <cmath>

#include "validation/diagnosis/evidence.h"

namespace deflect {
namespace {

constexpr std::size_t most_effects = 3, most_rounds = 6;
constexpr double sure = 0.9, together = 0.95;  // probabilities: of one alone; of those that tie
constexpr double better = 1;                   // ln of the odds for which one effect is taken for another
constexpr double never = -1e6;

/// Values of effect i of a hypothesis.
VectorX values_of(const Hypothesis& h, const VectorX& values, std::size_t i) {
  Eigen::Index at = 0;
  for (std::size_t k = 0; k < i; ++k) at += static_cast<Eigen::Index>(h[k].effect->parameters.size());
  return values.segment(at, static_cast<Eigen::Index>(h[i].effect->parameters.size()));
}

class Search {
 public:
  Search(Observations& o, const Candidates& c) : o_(o), candidates_(c) { s_.fit = fit_of_all(o, {}, VectorX(0)); }

  /// The best candidate beside what is there, if it is called for.
  bool add(const std::vector<Candidate>& all, double least) {
    const auto best = std::max_element(all.begin(), all.end(),
                                       [](const Candidate& a, const Candidate& b) { return odds(a) < odds(b); });
    if (best == all.end() || !(odds(*best) > least)) return false;
    if (!s_.effects.empty() && o_.held_out_rmse(device(best->hypothesis, best->fit.values)) >
                                   o_.held_out_rmse(device(s_.effects, s_.fit.values)))
      return false;
    grant(best->hypothesis, best->fit.values);
    return true;
  }

  std::vector<Candidate> further() const { return candidates_.beside(s_.effects, s_.fit, called_for); }

  /// Each effect asked again beside the others; true when one was dropped or exchanged.
  bool reconsider() {
    s_.ties.assign(s_.effects.size(), {});
    for (std::size_t i = 0; i < s_.effects.size(); ++i) {
      Hypothesis others = s_.effects;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      VectorX values(0);
      for (std::size_t k = 0; k < s_.effects.size(); ++k)
        if (k != i) {
          const VectorX own = values_of(s_.effects, s_.fit.values, k);
          values.conservativeResize(values.size() + own.size());
          values.tail(own.size()) = own;
        }
      const Fit rest = fit_of_all(o_, others, values);
      const std::vector<Candidate> all = candidates_.beside(others, rest, never);
      std::vector<double> log_odds;
      std::size_t best = 0, own = 0;
      for (std::size_t k = 0; k < all.size(); ++k) {
        log_odds.push_back(odds(all[k]));
        if (log_odds[k] > log_odds[best]) best = k;
        const PlacedEffect& e = all[k].added();
        if (e.effect == s_.effects[i].effect && e.leg == s_.effects[i].leg) own = k;
      }
      if (!others.empty() && log_odds[best] < called_for) {
        grant(others, rest.values);
        return true;
      }
      if (log_odds[best] > log_odds[own] + better) {
        grant(all[best].hypothesis, all[best].fit.values);
        return true;
      }
      s_.ties[i] = tie(all, log_odds);
    }
    return false;
  }

  Selection&& result() { return std::move(s_); }
  std::size_t size() const { return s_.effects.size(); }

 private:
  static double odds(const Candidate& c) { return c.fit.found ? c.log_odds : never; }

  Mechanism device(const Hypothesis& h, const VectorX& values) const {
    return h.empty() ? o_.device() : PreparedEffects(o_.device(), h)(values);
  }

  void grant(const Hypothesis& h, const VectorX& values) {
    o_.take_for_granted(device(h, values));
    s_.effects = h;
    s_.fit = fit_of_all(o_, h, values);
  }

  static std::vector<std::string> tie(const std::vector<Candidate>& all, const std::vector<double>& log_odds) {
    const std::vector<double> among = normalised(log_odds);
    std::vector<std::size_t> by(all.size());
    for (std::size_t i = 0; i < by.size(); ++i) by[i] = i;
    std::stable_sort(by.begin(), by.end(), [&](std::size_t a, std::size_t b) { return among[a] > among[b]; });
    if (by.empty() || among[by.front()] > sure) return {};
    std::vector<std::string> group;
    double sum = 0;
    for (const std::size_t i : by) {
      const std::string& name = all[i].added().effect->name;
      if (std::find(group.begin(), group.end(), name) == group.end()) group.push_back(name);
      if ((sum += among[i]) > together) break;
    }
    return group.size() > 1 ? group : std::vector<std::string>{};
  }

  Observations& o_;
  const Candidates& candidates_;
  Selection s_;
};

}  // namespace

Selection select(Observations& o, const Candidates& candidates, const std::vector<Candidate>& first) {
  Search search(o, candidates);
  if (!search.add(first, 0)) return search.result();
  for (std::size_t round = 0; round < most_rounds; ++round) {
    const bool changed = search.reconsider();
    if (changed) continue;
    if (search.size() == most_effects || !search.add(search.further(), called_for)) break;
  }
  return search.result();
}

}  // namespace deflect
