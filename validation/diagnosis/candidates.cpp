#include "validation/diagnosis/candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>

#include "msa/base/index.h"
#include "validation/diagnosis/evidence.h"
#include "validation/diagnosis/fit_problem.h"
#include "validation/diagnosis/pairs.h"
#include "validation/parallel/cases.h"
#include "validation/statistics/columns.h"

namespace deflect::diagnosis {
namespace {

constexpr double out_of_question = -1e9;           // ln of the odds of what is there already, or cannot be
constexpr double near_nothing = 6, hopeless = 30;  // gains in χ² that are not looked into
constexpr double bent = 8;                         // that a fit may gain beyond what the signature says, where small
constexpr double of_its_own = 0.05;                // share of a signature that others must leave it

std::vector<double> summed(const std::vector<double>& x, const std::vector<std::size_t>& classes) {
  std::vector<double> sum(x.size(), 0), out;
  for (std::size_t i = 0; i < x.size(); ++i) sum[classes[i]] += x[i];
  for (const std::size_t c : classes) out.push_back(sum[c]);
  return out;
}

std::vector<double> shared_priors(const std::vector<Signature>& all, const std::vector<std::size_t>& classes) {
  std::map<std::string, double> places;
  for (const Signature& s : all) places[s.effect.effect->name] += 1;
  const std::vector<double> looks = weights_of(all);
  std::vector<double> weight, largest(all.size(), 0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    weight.push_back(looks[i] / places[all[i].effect.effect->name]);
    largest[classes[i]] = std::max(largest[classes[i]], weight[i]);
  }
  const std::vector<double> together = summed(weight, classes);
  double total = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    weight[i] *= largest[classes[i]] / together[i];
    total += weight[i];
  }
  for (double& w : weight) w *= Candidates::prior_missing * (1 - Candidates::prior_unknown) / total;
  return weight;
}

constexpr double far_behind = 6;  // what is sure to be less likely than the best by this logarithm is not fitted
/// Fits that are begun together: first one, then twice as many each time, up to this. The next ones are compared with
/// the best of these, so that one that explains nearly all spares most others. The numbers do not depend on the
/// threads, so that the answer does not.
constexpr std::size_t at_once = 8;
constexpr double certain = 1e9;

/// Fits those signatures that can still come near the best, which promise the most first. `promise` returns the most
/// that ln of the odds of a signature's class can become by its fit; it may learn from the fits so far, of which
/// `fitted` is told. `fit_one`, given the signature and the number of threads within, returns ln of the odds found.
/// Returns the bar that further ones must exceed.
template <class Promise, class FitOne, class Fitted>
double fit_in_turn(std::vector<std::size_t> all, double bar, int threads, const Promise& promise, const FitOne& fit_one,
                   const Fitted& fitted) {
  for (std::size_t count = 0; !all.empty();) {
    std::map<std::size_t, double> most;
    for (const std::size_t i : all) most[i] = promise(i);
    std::erase_if(all, [&](std::size_t i) { return !(most[i] > bar); });
    std::stable_sort(all.begin(), all.end(), [&](std::size_t a, std::size_t b) { return most[a] > most[b]; });
    count = std::min({std::max<std::size_t>(1, 2 * count), at_once, all.size()});
    // Where few are fitted, one with many starts would keep one thread busy long after the others.
    const int within = count < at_once ? threads : 1;
    parallel::for_each_case(count, 1, threads, [&](std::size_t k) { fit_one(all[k], within); });
    for (std::size_t k = 0; k < count; ++k) bar = std::max(bar, fitted(all[k]) - far_behind);
    all.erase(all.begin(), all.begin() + as_index(count));
  }
  return bar;
}

/// Physics lets it act to one side only, and the residual asks for the other.
bool wrong_way(const Signature& s, const VectorX& residual) {
  return !s.shaped && s.one_sided && s.start_along(residual) > 0;
}

constexpr double small_share = 0.05;  // of the best gain, from which a signature may hide a large effect
constexpr double most_of_it = 0.5;    // of what a law at a place explains: the part gone may explain it instead

/// Of one parameter with a value at which it vanishes: its signature is that of a small size.
bool has_one_size(const Signature& s) {
  const std::vector<effects::EffectParameter>& all = s.effect.effect->parameters;
  return !s.shaped && all.size() == 1 && all.front().vanishes;
}

Fit better(Fit a, Fit b) { return b.found && (!a.found || b.chi2 < a.chi2) ? b : a; }

/// The columns of the effects whose shape is fixed: these alone take the place of another that does all but the same.
/// The derivatives of a friction or a play say what it does near where it is, and it moves when another joins it.
MatrixX columns_of_unshaped(const Hypothesis& h, const MatrixX& signature) {
  std::vector<Eigen::Index> columns;
  Eigen::Index at = 0;
  for (const effects::PlacedEffect& e : h)
    for (std::size_t i = 0; i < e.effect->parameters.size(); ++i, ++at)
      if (!is_shaped(e)) columns.push_back(at);
  return signature(Eigen::all, columns);
}

bool same(const effects::PlacedEffect& a, const effects::PlacedEffect& b) {
  return a.effect == b.effect && a.leg == b.leg;
}

}  // namespace

Candidates::Candidates(const std::vector<Signature>& all, int threads,
                       std::function<void(std::size_t, std::size_t)> progress)
    : signatures_(all),
      threads_(threads),
      progress_(std::move(progress)),
      between_(inner_products(all)),
      classes_(classes_of(all, between_)),
      lets_go_(those_that_let_go(all)),
      priors_(shared_priors(all, classes_)),
      class_priors_(summed(priors_, classes_)) {}

Candidates Candidates::in_larger_sizes() const {
  Candidates out = *this;
  out.larger_sizes_ = true;
  return out;
}

double Candidates::log_odds(std::size_t i, double gain, double prior) const {
  const Signature& s = signatures_[i];
  // Of the shapes tried one in three, or so, does what the best does.
  const double shape = s.shaped ? std::log(3.0) : 0;
  return std::log(prior / (1 - prior_missing)) + log_evidence(gain, s.amplitudes(), s.one_sided) - shape;
}

double Candidates::class_log_odds_of(const effects::PlacedEffect& e, double gain) const {
  for (std::size_t i = 0; i < signatures_.size(); ++i)
    if (same(signatures_[i].effect, e)) return log_odds(i, gain, class_priors_[i]);
  return out_of_question;
}

void Candidates::add_up_classes(std::vector<Candidate>& all) const {
  std::vector<double> most(all.size(), out_of_question), sum(all.size(), 0);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].fit.found) most[classes_[i]] = std::max(most[classes_[i]], all[i].log_odds);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].fit.found) sum[classes_[i]] += std::exp(all[i].log_odds - most[classes_[i]]);
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i].class_log_odds = all[i].fit.found ? most[classes_[i]] + std::log(sum[classes_[i]]) : out_of_question;
}

/// Each effect added to those that are fitted so far.
class Candidates::Round {
 public:
  Round(const Candidates& all, const Observations& o, const Hypothesis& before, const Fit& so_far,
        const std::optional<effects::EffectInstance>& known)
      : all_(all), observations_(o), so_far_(so_far), known_(known), out_(all.signatures_.size()) {
    const MatrixX fitted = statistics::orthonormal(so_far.signature);
    const MatrixX proportional = statistics::orthonormal(columns_of_unshaped(before, so_far.signature));
    for (std::size_t i = 0; i < out_.size(); ++i) {
      const Signature& s = signature(i);
      out_[i].hypothesis = before;
      out_[i].hypothesis.push_back(s.effect);
      const bool there = std::any_of(before.begin(), before.end(), [&](const auto& p) { return same(p, s.effect); });
      allowed_.push_back(!there && own_share(s, proportional) > of_its_own);
      said_.push_back(
          !allowed_[i] || wrong_way(s, so_far.residual)
              ? 0
              : std::max(most_gain(s, so_far.residual, fitted), most_gain(s, so_far.residual, proportional)));
      out_[i].gain = said_[i];
      out_[i].log_odds = allowed_[i] ? all_.log_odds(i, said_[i], all_.priors_[i]) : out_of_question;
    }
    if (!said_.empty()) most_ = *std::max_element(said_.begin(), said_.end());
  }

  /// Fits those that can come near the best and whose odds can exceed `least`. Entries first: of the many laws at
  /// places only those are fitted that can come near them.
  void fit_promising(double least) {
    std::array<std::vector<std::size_t>, 2> parts;
    for (std::size_t i = 0; i < out_.size(); ++i)
      if (allowed_[i] && (is_known(i) || said_[i] >= enough(signature(i))))
        parts[signature(i).effect.effect->place ? 1 : 0].push_back(i);
    const std::size_t count = parts[0].size() + parts[1].size();
    std::atomic<std::size_t> done = 0;
    const auto fit_one = [&](std::size_t i, int within) {
      fit_from(i, guess(signature(i), so_far_.residual), within);
      if (all_.progress_) all_.progress_(++done, count);
    };
    CanGain can_gain;
    bar_ = least;
    for (std::vector<std::size_t>& part : parts)
      bar_ = fit_in_turn(
          std::move(part), bar_, all_.threads_,
          [&](std::size_t i) {
            return is_known(i) ? certain : all_.log_odds(i, can_gain(signature(i), said_[i]), all_.class_priors_[i]);
          },
          fit_one,
          [&](std::size_t i) {
            can_gain.note(signature(i), said_[i], out_[i].gain);
            return odds(i);
          });
    if (all_.progress_) all_.progress_(1, 1);
  }

  /// Fits anew, from a larger size, those that explain more in it than as they were fitted, if at all. A signature is
  /// that of a small size: play as wide as the motion, or a support that yields until it is gone, moves the readings in
  /// another direction than a little of it. Returns whether one of these is the likeliest then.
  bool fit_larger() {
    const double before = likeliest();
    fit_from_sizes([&](std::size_t i) -> std::optional<SizedEffect> {
      if (!allowed_[i] || !has_one_size(signature(i)) || said_[i] < std::max(near_nothing, small_share * most_))
        return std::nullopt;
      const std::optional<VectorX> small = guess(signature(i), so_far_.residual);
      return small ? best_size(observations_, out_[i].hypothesis, so_far_.values, *small) : std::nullopt;
    });
    return likeliest() > before;
  }

  /// Where a part that lets go is among the likeliest, or was found before, fits all laws by which it can (lets_go())
  /// at that place from the size that explains most. Play so wide that nothing touches says the same as a spring that
  /// has run to nothing, but a fit that begins with a little play does not come there.
  void fit_what_lets_go() {
    std::vector<double> explained(out_.size(), 0);  // by the best of them at the place
    for (std::size_t i = 0; i < out_.size(); ++i) {
      if (!all_.lets_go_[i] || !(odds(i) > bar_ || (is_known(i) && out_[i].fit.found))) continue;
      for (std::size_t k = 0; k < out_.size(); ++k)
        if (all_.lets_go_[k] && allowed_[k] && at_one_place(signature(i).effect, signature(k).effect))
          explained[k] = std::max(explained[k], out_[i].gain);
    }
    fit_from_sizes([&](std::size_t i) -> std::optional<SizedEffect> {
      if (!(explained[i] > near_nothing)) return std::nullopt;
      return best_size_of_what_lets_go(observations_, out_[i].hypothesis, so_far_.values,
                                       so_far_.chi2 - most_of_it * explained[i]);
    });
  }

  /// What was fitted before, in place of fit_promising().
  void take(const std::vector<Candidate>& fitted) {
    out_ = fitted;
    bar_ = likeliest() - far_behind;
  }

  std::vector<Candidate>&& result() {
    for (Candidate& c : out_) c.chi2_per_dof = (so_far_.chi2 - c.gain) / static_cast<double>(observations_.numbers());
    all_.add_up_classes(out_);
    return std::move(out_);
  }

 private:
  /// What a fit may gain where the signature says so much: little more where one law at a place is nearly proportional.
  /// A few shapes of a law that bends say less, and how much less is alike at all places of that law: once it is fitted
  /// at one place, as much more is expected of the others.
  class CanGain {
   public:
    double operator()(const Signature& s, double said) const {
      if (!s.shaped) return s.effect.effect->place ? 1.1 * said + 3 : 1.2 * said + bent;
      const auto of_law = times_.find(law_of(s));
      return (of_law == times_.end() ? usual : std::max(usual, of_law->second)) * said + bent;
    }

    void note(const Signature& s, double said, double gained) {
      if (!s.shaped || said < near_nothing) return;
      double& most = times_[law_of(s)];
      most = std::max(most, (gained - bent) / said);
    }

   private:
    static constexpr double usual = 1.2;
    static std::string law_of(const Signature& s) {
      const std::string& name = s.effect.effect->name;
      return name.substr(0, name.find('@'));
    }
    std::map<std::string, double> times_;
  };

  const Signature& signature(std::size_t i) const { return all_.signatures_[i]; }
  bool is_known(std::size_t i) const { return known_ && same(*known_, signature(i).effect); }
  double odds(std::size_t i) const { return out_[i].fit.found ? out_[i].log_odds : out_of_question; }
  double likeliest() const {
    double most = out_of_question;
    for (std::size_t i = 0; i < out_.size(); ++i) most = std::max(most, odds(i));
    return most;
  }

  /// What a signature must say that could be gained. A few directions say less of an effect that parameters shape than
  /// of one that is proportional to its size.
  double enough(const Signature& s) const { return std::max(near_nothing, (s.shaped ? 0.1 : 0.5) * most_ - hopeless); }

  /// Fits anew, from the size that `size_of` tells of a signature, if any, those that explain more in it than as they
  /// were fitted.
  template <class SizeOf>
  void fit_from_sizes(const SizeOf& size_of) {
    std::vector<std::optional<SizedEffect>> sized(out_.size());
    parallel::for_each_case(out_.size(), 1, all_.threads_, [&](std::size_t i) {
      sized[i] = size_of(i);
      if (sized[i] && !(sized[i]->chi2 < (out_[i].fit.found ? out_[i].fit : so_far_).chi2)) sized[i].reset();
    });
    std::vector<std::size_t> promising;
    for (std::size_t i = 0; i < sized.size(); ++i)
      if (sized[i]) promising.push_back(i);
    fit_in_turn(
        std::move(promising), bar_, all_.threads_,
        [&](std::size_t i) {
          return all_.log_odds(i, 1.5 * (so_far_.chi2 - sized[i]->chi2) + bent, all_.class_priors_[i]);
        },
        [&](std::size_t i, int within) { fit_from(i, sized[i]->value, within); },
        [&](std::size_t i) { return odds(i); });
  }

  void fit_from(std::size_t i, const std::optional<VectorX>& start, int within) {
    Candidate& c = out_[i];
    Fit now = fit(observations_, c.hypothesis, so_far_.values, start, within);
    c.fit = c.fit.found ? better(std::move(c.fit), std::move(now)) : std::move(now);
    if (is_known(i)) c.fit = better(std::move(c.fit), fit(observations_, c.hypothesis, so_far_.values, known_->values));
    if (signature(i).effect.effect->place && wants_more_than_there_can_be(c.hypothesis, c.fit))
      c.fit = not_found(fmt::format("its {} runs to the end of what it can be, {:g}",
                                    c.added().effect->parameters.front().name, c.fit.values.tail<1>()(0)));
    c.gain = c.fit.found ? std::max(0.0, so_far_.chi2 - c.fit.chi2) : 0;
    c.log_odds = all_.log_odds(i, c.gain, all_.priors_[i]);
  }

  const Candidates& all_;
  const Observations& observations_;
  const Fit& so_far_;
  std::optional<effects::EffectInstance> known_;
  std::vector<Candidate> out_;
  std::vector<char> allowed_;
  std::vector<double> said_;  // gains in χ² that the signatures promise
  double most_ = 0, bar_ = 0;
};

std::vector<Candidate> Candidates::beside(const Observations& observations, const Hypothesis& before, const Fit& so_far,
                                          double least, const std::optional<effects::EffectInstance>& known) const {
  Round round(*this, observations, before, so_far, known);
  round.fit_promising(least);
  round.fit_what_lets_go();
  if (larger_sizes_) round.fit_larger();
  return round.result();
}

std::optional<std::vector<Candidate>> Candidates::likelier_if_larger(const Observations& observations,
                                                                     const Hypothesis& before, const Fit& so_far,
                                                                     const std::vector<Candidate>& fitted) const {
  Round round(*this, observations, before, so_far, {});
  round.take(fitted);
  if (!round.fit_larger()) return std::nullopt;
  return round.result();
}

std::optional<TwoCandidates> Candidates::two_beside(const Observations& o, const Hypothesis& before, const Fit& so_far,
                                                    double least, double each) const {
  constexpr std::size_t looked_at = 4;
  constexpr double signatures_may_miss = 4;  // of ln of the odds
  const MatrixX fitted = statistics::orthonormal(so_far.signature);
  const auto of_class = [&](std::size_t i, double gain) { return log_odds(i, gain, class_priors_[i]); };
  const std::vector<PairOfSignatures> promising =
      best_pairs(signatures_, between_, so_far.residual, fitted, of_class, least - signatures_may_miss, looked_at);
  const auto together = [&](const Hypothesis& others, const Fit& fitted_so_far, std::size_t i) {
    Hypothesis h = others;
    h.push_back(signatures_[i].effect);
    return TwoCandidates{h, fit(o, h, fitted_so_far.values, guess(signatures_[i], fitted_so_far.residual))};
  };
  std::map<std::size_t, TwoCandidates> alone;  // the first ones of pairs, each fitted once
  for (const PairOfSignatures& p : promising) alone[p.first];
  parallel::for_each_case(alone.size(), 1, threads_, [&](std::size_t k) {
    auto& [first, fitted_alone] = *std::next(alone.begin(), as_index(k));
    fitted_alone = together(before, so_far, first);
  });
  std::vector<TwoCandidates> all(promising.size(), {{}, {}, out_of_question});
  parallel::for_each_case(promising.size(), 1, threads_, [&](std::size_t k) {
    const auto [first, second, gain_of_first, gain] = promising[k];
    const TwoCandidates& one = alone.at(first);
    if (!one.fit.found) return;
    TwoCandidates both = together(one.hypothesis, one.fit, second);
    if (!both.fit.found || wants_more_than_there_can_be(both.hypothesis, both.fit)) return;
    const double of_second = of_class(second, std::max(0.0, one.fit.chi2 - both.fit.chi2));
    both.log_odds = of_class(first, std::max(0.0, so_far.chi2 - one.fit.chi2)) + of_second;
    if (of_second < each || !(both.log_odds > least)) return;
    const TwoCandidates other = together(before, so_far, second);
    if (!other.fit.found || of_class(first, std::max(0.0, other.fit.chi2 - both.fit.chi2)) < each) return;
    all[k] = std::move(both);
  });
  const auto best = std::ranges::max_element(all, {}, &TwoCandidates::log_odds);
  return best == all.end() || best->log_odds <= least ? std::nullopt : std::optional(std::move(*best));
}

void add_left_out(std::vector<LeftOut>& noted, const std::vector<Candidate>& all) {
  for (const Candidate& c : all) {
    if (c.fit.found || c.fit.why.empty()) continue;
    std::string name = name_of(c.added());
    for (std::size_t i = 0; i + 1 < c.hypothesis.size(); ++i)
      name += (i == 0 ? " beside " : " and ") + name_of(c.hypothesis[i]);
    if (std::none_of(noted.begin(), noted.end(), [&](const LeftOut& l) { return l.effect == name; }))
      noted.push_back({name, c.fit.why});
  }
}

}  // namespace deflect::diagnosis
