#include "validation/diagnosis/selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "msa/base/index.h"

namespace deflect::diagnosis {
namespace {

constexpr std::size_t usual_effects = 4, most_effects = 6, most_rounds = 12;
constexpr double own_part_of_many = 0.5;  // of χ²: what more effects than usual must take off, each
constexpr double better = 1;              // ln of the odds for which one effect is taken for another
constexpr double never = -1e6;
constexpr double far_worse = 2;  // times the error in the shape that was granted before
constexpr int most_passes = 6;

class Search {
 public:
  Search(const Observations& o, const Candidates& c)
      : s_{o, {}, fit_of_all(o, {}, VectorX(0)), {}, {}}, candidates_(c) {}

  /// The best candidate beside what is there, if it is called for.
  bool add(const std::vector<Candidate>& all, double least) {
    const auto best = std::max_element(all.begin(), all.end(), less_likely);
    if (best == all.end() || !(best->class_log_odds > least) || granted_before(best->hypothesis)) return false;
    if (s_.effects.size() >= usual_effects && best->fit.chi2 > own_part_of_many * s_.fit.chi2) return false;
    if (!s_.effects.empty() && !falls(best->hypothesis, best->fit.values)) return false;
    grant(best->hypothesis, best->fit.values);
    return true;
  }

  std::vector<Candidate> further() { return beside(seen(), s_.effects, s_.fit, called_for); }

  /// Each effect asked again beside the others; true when one was dropped or exchanged, so that all are asked again.
  bool reconsider() {
    for (std::size_t i = 0; i < s_.effects.size(); ++i) {
      const std::optional<AskedAgain> asked = asked_again(i);
      if (!asked) continue;
      const auto& [others, rest, all, own] = *asked;
      const auto best = std::max_element(all.begin(), all.end(), less_likely);
      // Effects may go together in one order only: then the fit at hand tells what this one gains.
      const double odds =
          own.fit.found ? own.class_log_odds : candidates_.class_log_odds_of(s_.effects[i], gain(rest, s_.fit));
      if (!others.empty() && std::max(best->class_log_odds, odds) < called_for) {
        grant(others, rest.values);
        return true;
      }
      if (!best->fit.found) continue;
      const double more = best->class_log_odds - odds;
      if ((more > better || (more == 0 && best->log_odds > own.log_odds + better)) && !goes_back(best->hypothesis)) {
        grant(best->hypothesis, best->fit.values);
        return true;
      }
      if (const Candidate* simpler = simpler_form(own, all, seen())) {
        const Candidate instead = *simpler;
        const bool back = goes_back(instead.hypothesis);
        grant(instead.hypothesis, instead.fit.values);
        if (!back) return true;
        // Each looks likelier where the other one is granted: the simpler one stays, and what looks as likely ties.
        note_ties();
        return false;
      }
      s_.ties[i] = tie_of(all, seen());
      if (s_.ties[i].names.empty()) continue;
      if (!s_.ties[i].holds(own) && !goes_back(s_.ties[i].rivals.front().hypothesis)) {
        const Candidate instead = s_.ties[i].rivals.front();
        grant(instead.hypothesis, instead.fit.values);
        return true;
      }
      if (own.fit.found) s_.ties[i].put_first(own);
    }
    return false;
  }

  /// What ties with each effect as it is.
  void note_ties() {
    for (std::size_t i = 0; i < s_.effects.size(); ++i) {
      const std::optional<AskedAgain> asked = asked_again(i);
      s_.ties[i] = asked && asked->own.fit.found ? tie_of(asked->all, seen()) : Tie{};
      if (!s_.ties[i].names.empty()) s_.ties[i].put_first(asked->own);
    }
  }

  /// A single effect, or two at once of a few, exchanged for two others that explain the data better together; true
  /// when that was done.
  bool exchange_for_two() {
    const std::size_t n = s_.effects.size();
    if (n == 1) return exchange({0}, called_for);
    for (std::size_t i = 1; i < n && n <= usual_effects; ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (exchange({k, i}, better)) return true;
    return false;
  }

  const Selection& so_far() const { return s_; }
  Selection&& result() { return std::move(s_); }
  std::size_t size() const { return s_.effects.size(); }

 private:
  std::vector<Candidate> beside(const Observations& o, const Hypothesis& others, const Fit& so_far, double least,
                                const std::optional<effects::EffectInstance>& known = {}) {
    std::vector<Candidate> all = candidates_.beside(o, others, so_far, least, known);
    add_left_out(s_.left_out, all);
    return all;
  }

  /// The candidates beside all effects but one, which is among them.
  struct AskedAgain {
    Hypothesis others;
    Fit rest;
    std::vector<Candidate> all;
    Candidate own;
  };
  /// Nothing where the others need effect i.
  std::optional<AskedAgain> asked_again(std::size_t i) {
    auto [others, values] = without(s_.effects, s_.fit.values, i);
    Fit rest = fit_of_all(seen(), others, values);
    if (!rest.found) return std::nullopt;
    std::vector<Candidate> all = beside(in_shape_of(others, rest), others, rest, never, present(i));
    Candidate own = *std::find_if(all.begin(), all.end(), [&](const Candidate& c) {
      return c.added().effect == s_.effects[i].effect && c.added().leg == s_.effects[i].leg;
    });
    return AskedAgain{std::move(others), std::move(rest), std::move(all), std::move(own)};
  }

  /// Effect i as it is fitted now.
  effects::EffectInstance present(std::size_t i) const {
    Eigen::Index first = 0;
    for (std::size_t k = 0; k < i; ++k) first += std::ssize(s_.effects[k].effect->parameters);
    return {s_.effects[i], s_.fit.values.segment(first, std::ssize(s_.effects[i].effect->parameters))};
  }

  const Observations& seen() const { return s_.observations; }
  /// As seen where these effects alone are right: without the play that has gone with another.
  Observations in_shape_of(const Hypothesis& h, const Fit& f) const {
    return seen().in_shape_of(subject_with(seen(), h, f.values));
  }

  /// Those effects, given in order, exchanged for two others whose odds are better by `more`.
  bool exchange(const std::vector<std::size_t>& given, double more) {
    Hypothesis others = s_.effects;
    VectorX values = s_.fit.values;
    for (std::size_t k = given.size(); k-- > 0;) std::tie(others, values) = without(others, values, given[k]);
    const Fit rest = fit_of_all(seen(), others, values);
    if (!rest.found) return false;  // the others need them
    const double now = given.size() == 1
                           ? candidates_.class_log_odds_of(s_.effects[given[0]], gain(rest, s_.fit))
                           : std::max(odds_of_two(rest, given[0], given[1]), odds_of_two(rest, given[1], given[0]));
    const std::optional<TwoCandidates> two =
        candidates_.two_beside(in_shape_of(others, rest), others, rest, now + more, called_for);
    if (!two || !falls(two->hypothesis, two->fit.values)) return false;
    grant(two->hypothesis, two->fit.values);
    return true;
  }

  /// ln of the odds of effect `first` beside the others and of effect `second` beside these, all as they are fitted.
  double odds_of_two(const Fit& rest, std::size_t first, std::size_t second) const {
    const auto [h, values] = without(s_.effects, s_.fit.values, second);
    const Fit alone = fit_of_all(seen(), h, values);
    if (!alone.found) return never;
    const double of_first = gain(rest, alone);
    return candidates_.class_log_odds_of(s_.effects[first], of_first) +
           candidates_.class_log_odds_of(s_.effects[second], std::max(0.0, gain(rest, s_.fit) - of_first));
  }

  static double gain(const Fit& without, const Fit& with) { return std::max(0.0, without.chi2 - with.chi2); }

  bool falls(const Hypothesis& h, const VectorX& values) const {
    return seen().falls_held_out(subject_with(seen(), h, values), subject_with(seen(), s_.effects, s_.fit.values));
  }

  /// By what is the same to these data, then by the entry's own.
  static bool less_likely(const Candidate& a, const Candidate& b) {
    return std::pair(a.class_log_odds, a.log_odds) < std::pair(b.class_log_odds, b.log_odds);
  }

  struct Granted {
    Hypothesis effects;
    double log_likelihood = 0;
  };
  /// These effects, in any order, where they counted as right before.
  const Granted* granted_before(const Hypothesis& h) const {
    const auto it = std::find_if(granted_.begin(), granted_.end(), [&](const Granted& g) {
      return g.effects.size() == h.size() &&
             std::all_of(h.begin(), h.end(), [&](const auto& e) { return is_among(g.effects, e); });
    });
    return it == granted_.end() ? nullptr : &*it;
  }
  /// Whether they counted as right before, when the readings were no likelier than they are now. To each of two effects
  /// the other one can look likelier, because what is granted moves weights and shapes.
  bool goes_back(const Hypothesis& h) const {
    const Granted* before = granted_before(h);
    return before && before->log_likelihood <= granted_.back().log_likelihood;
  }

  void grant(const Hypothesis& h, const VectorX& values) {
    count_as_right(h, values);
    granted_.push_back({s_.effects, log_likelihood(seen(), s_.effects, s_.fit.values)});
  }

  /// These effects count as right, at the values with which the deformed shape is that of the subject they make. Where
  /// passes do not lead there, with the shape at the values given; where that shape makes the error far larger, so that
  /// only a tolerance many times as large as it may be takes it off again, with the shape that was granted before.
  void count_as_right(const Hypothesis& h, const VectorX& given) {
    VectorX values = given;
    std::optional<Selection> first;
    const auto error = [&](const Observations& o) { return o.rmse(subject_with(o, h, values)); };
    const double error_before = error(seen());
    double before = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < most_passes; ++pass) {
      Observations next = seen().granted(subject_with(seen(), h, values));
      Fit again = fit_of_all(next, h, values);
      if (!again.found && first) break;
      if (!again.found) throw std::logic_error("a fit that was found is not found again");
      again = searched_again(next, h, std::move(again), candidates_.threads());
      values = again.values;
      if (error(next) > far_worse * error_before) {
        if (first) break;
        if (Fit as_before = fit_of_all(seen(), h, given); as_before.found) return take(h, seen(), std::move(as_before));
      }
      take(h, std::move(next), std::move(again));
      const double change = seen().change_of_shape(subject_with(seen(), h, values));
      if (!(change > known_shape)) return;
      if (!first) first = s_;
      if (!(change < before)) break;
      before = change;
    }
    s_ = std::move(*first);
  }

  void take(const Hypothesis& h, Observations o, Fit f) {
    s_.observations = std::move(o);
    s_.effects = h;
    s_.fit = std::move(f);
    s_.ties.assign(h.size(), {});
  }

  Selection s_;
  const Candidates& candidates_;
  std::vector<Granted> granted_;
};

}  // namespace

Selection select(const Observations& o, const Candidates& candidates, const std::vector<Candidate>& first,
                 const std::function<bool(const Selection&)>& enough) {
  Search search(o, candidates);
  if (!search.add(first, 0)) return search.result();
  for (std::size_t round = 0; round < most_rounds; ++round) {
    if (search.reconsider() || search.exchange_for_two()) continue;
    if (enough && search.size() > 1 && enough(search.so_far())) return search.result();
    if (search.size() == most_effects || !search.add(search.further(), called_for)) return search.result();
  }
  search.note_ties();
  return search.result();
}

std::vector<effects::EffectInstance> as_fitted(const Selection& s) {
  std::vector<effects::EffectInstance> out;
  Eigen::Index at = 0;
  for (const effects::PlacedEffect& e : s.effects) {
    const auto count = std::ssize(e.effect->parameters);
    out.push_back({e, s.fit.values.segment(at, count)});
    at += count;
  }
  for (const Tie& t : s.ties)
    for (const Candidate& c : t.rivals)
      if (c.fit.found) out.push_back({c.added(), c.fit.values.tail(std::ssize(c.added().effect->parameters))});
  return out;
}

double log_odds_of_all(const Candidates& candidates, const Hypothesis& effects, double gain) {
  const double each = std::max(0.0, gain) / std::max(1.0, static_cast<double>(effects.size()));
  double sum = 0;
  for (const effects::PlacedEffect& e : effects) sum += candidates.class_log_odds_of(e, each);
  return sum;
}

}  // namespace deflect::diagnosis
