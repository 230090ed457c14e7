#include "validation/diagnosis/candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>

#include "msa/base/index.h"
#include "validation/diagnosis/fit_in_turn.h"
#include "validation/diagnosis/fit_problem.h"
#include "validation/effects/law_of_effect.h"
#include "validation/parallel/cases.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/evidence.h"

namespace deflect::diagnosis {
namespace {

constexpr double hopeless = 30;                  // gain in χ² that is not looked into
constexpr double of_its_own = 0.05;              // share of a signature that others must leave it
constexpr double behind_in_another_shape = 0.5;  // of the best odds: what may still be the best in its own shape
constexpr std::size_t most_exact = 16;           // fits in true geometry
constexpr double grows_faster = 2;               // the deformed shape, where it grows much, than for small changes

constexpr double small_share = 0.05;  // of the best gain, from which a signature may hide a large effect
constexpr double same_chi2 = 1e-3;
constexpr double most_of_it = 0.5;  // of what a law at a place explains: the part gone may explain it instead

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

}  // namespace

Candidates::Candidates(const std::vector<Signature>& all, int threads,
                       std::function<void(std::size_t, std::size_t)> progress)
    : signatures_(all),
      threads_(threads),
      progress_(std::move(progress)),
      between_(inner_products(all, threads)),
      classes_(classes_of(all, between_)),
      lets_go_(those_that_let_go(all)),
      priors_(shared_priors(all, classes_, prior_missing * (1 - prior_unknown))),
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
  return std::log(prior / (1 - prior_missing)) + statistics::log_evidence(gain, s.amplitudes(), s.one_sided) - shape;
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
      : all_(all),
        observations_(o),
        before_(before),
        so_far_(so_far),
        chi2_before_(so_far.chi2),
        known_(known),
        out_(all.signatures_.size()) {
    const MatrixX fitted = statistics::orthonormal(so_far.signature);
    const MatrixX proportional = statistics::orthonormal(columns_of_unshaped(before, so_far.signature));
    const bool some_shaped = proportional.cols() < fitted.cols();
    allowed_.resize(out_.size()), said_.resize(out_.size());
    parallel::for_each_case(out_.size(), 1, all.threads_, [&](std::size_t i) {
      const Signature& s = signature(i);
      (out_[i].hypothesis = before).push_back(s.effect);
      allowed_[i] = !is_among(before, s.effect) && own_share(s, proportional) > of_its_own;
      const bool may = allowed_[i] && !wrong_way(s, so_far.residual);
      if (may) said_[i] = most_gain(s, so_far.residual, fitted);
      if (may && some_shaped) said_[i] = std::max(said_[i], most_gain(s, so_far.residual, proportional));
      out_[i].gain = said_[i];
      out_[i].log_odds = allowed_[i] ? all_.log_odds(i, said_[i], all_.priors_[i]) : out_of_question;
    });
    for (std::size_t i = 0; i < out_.size(); ++i)
      if (is_known(i)) class_of_known_ = all_.classes_[i];
    if (!said_.empty()) most_ = *std::max_element(said_.begin(), said_.end());
  }

  /// Fits those that can come near the best and whose odds can exceed `least`. Entries first: of the many laws at
  /// places only those are fitted that can come near them.
  void fit_promising(double least) {
    std::array<std::vector<std::size_t>, 2> parts;
    for (std::size_t i = 0; i < out_.size(); ++i)
      if (allowed_[i] && (is_near_known(i) || said_[i] >= enough(signature(i))))
        parts[signature(i).effect.effect->place ? 1 : 0].push_back(i);
    const std::size_t count = parts[0].size() + parts[1].size();
    std::atomic<std::size_t> done = 0;
    const auto fit_one = [&](std::size_t i, int within) {
      fit_from(i, guess(signature(i), so_far_.residual), within);
      if (all_.progress_) all_.progress_(++done, count);
    };
    CanGain can_gain;
    bar_ = least;
    const double behind = observations_.is_slender() ? behind_in_another_shape : 0;
    for (std::vector<std::size_t>& part : parts)
      bar_ = fit_in_turn(
          std::move(part), bar_, all_.threads_,
          [&](std::size_t i) {
            return is_near_known(i) ? certain
                                    : all_.log_odds(i, can_gain(signature(i), said_[i]), all_.class_priors_[i]);
          },
          fit_one,
          [&](std::size_t i) {
            can_gain.note(signature(i), said_[i], out_[i].gain);
            return odds(i);
          },
          behind);
    if (all_.progress_) all_.progress_(1, 1);
  }

  /// Fits anew, from a larger size, those that explain more in it than as they were fitted, if at all: play as wide as
  /// the motion moves the readings in another direction than a little of it. Returns whether one is the likeliest then.
  bool fit_larger(bool all) {
    const double before = likeliest();
    fit_from_sizes([&](std::size_t i) -> std::optional<SizedEffect> {
      const Signature& s = signature(i);
      const bool may =
          turns_as_it_grows(*s.effect.effect) || (all && said_[i] >= std::max(near_nothing, small_share * most_));
      if (!allowed_[i] || !has_one_size(s) || !may) return std::nullopt;
      return best_size(observations_, out_[i].hypothesis, so_far_.values, guess(s, so_far_.residual));
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

  /// Where the deformed shape does much, each effect has its own. Those that could come near the best in theirs are
  /// fitted anew, each predicted in its true geometry.
  void fit_in_true_geometry() {
    if (!observations_.is_slender()) return;
    const Observations exact = true_geometry();
    std::vector<std::optional<double>> promised(out_.size());
    parallel::for_each_case(out_.size(), 1, all_.threads_,
                            [&](std::size_t i) { promised[i] = promised_in_own_shape(i); });
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < out_.size(); ++i)
      if (promised[i]) near.push_back(i);
    std::stable_sort(near.begin(), near.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(promised[a], out_[a].log_odds) > std::pair(promised[b], out_[b].log_odds);
    });
    if (near.size() > most_exact) near.resize(most_exact);
    std::map<std::size_t, double> of_class;  // what these data cannot distinguish does as well
    fit_in_turn(
        std::move(near), likeliest() - far_behind, all_.threads_,
        [&](std::size_t i) {
          const auto same = of_class.find(all_.classes_[i]);
          return same == of_class.end() ? *promised[i] : std::max(*promised[i], same->second);
        },
        [&](std::size_t i, int) {
          out_[i].fit = fit_of_all(exact, out_[i].hypothesis, out_[i].fit.values);
          judge(i);
        },
        [&](std::size_t i) {
          double& most = of_class.try_emplace(all_.classes_[i], out_of_question).first->second;
          most = std::max(most, odds(i));
          return odds(i);
        });
    if (!leaves_much()) return;
    geometry_ = &exact;  // a large effect was not fitted at all where its size shows in the deformed shape alone
    fit_from_sizes([&](std::size_t i) -> std::optional<SizedEffect> {
      if (!allowed_[i] || out_[i].fit.found || !has_one_size(signature(i))) return std::nullopt;
      return best_size(exact, out_[i].hypothesis, so_far_.values, guess(signature(i), so_far_.residual));
    });
    geometry_ = &observations_;
  }

  /// What was fitted before, in place of fit_promising().
  void take(const std::vector<Candidate>& fitted) {
    out_ = fitted;
    bar_ = likeliest() - far_behind;
  }

  /// Fits anew, from these values, those that explain more from there.
  void fit_again(const std::vector<effects::EffectInstance>& from) {
    std::optional<Observations> exact;
    if (observations_.is_slender()) exact = true_geometry();
    const Observations& o = exact ? *exact : observations_;
    for (const effects::EffectInstance& e : from)
      for (std::size_t i = 0; i < out_.size(); ++i) {
        if (!same(e, signature(i).effect)) continue;
        Fit again = fit(o, out_[i].hypothesis, so_far_.values, e.values);
        if (!again.found || (out_[i].fit.found && out_[i].fit.chi2 < again.chi2 + same_chi2)) continue;
        out_[i].fit = std::move(again);
        judge(i);
      }
  }

  std::vector<Candidate>&& result() {
    // A gain that a signature says can exceed all there is by rounding.
    for (Candidate& c : out_)
      c.chi2_per_dof = std::max(0.0, chi2_before_ - c.gain) / static_cast<double>(observations_.numbers());
    all_.add_up_classes(out_);
    return std::move(out_);
  }

 private:
  /// In which the candidates are compared from now on.
  Observations true_geometry() {
    Observations exact = observations_.in_true_geometry();
    if (const Fit before = fit_of_all(exact, before_, so_far_.values); before.found) chi2_before_ = before.chi2;
    return exact;
  }

  /// The most that ln of the odds can become in its own deformed shape, where that is another one.
  std::optional<double> promised_in_own_shape(std::size_t i) {
    const Candidate& c = out_[i];
    if (!c.fit.found) return std::nullopt;
    judge(i);
    const double shape = observations_.change_of_shape(subject_with(observations_, c.hypothesis, c.fit.values));
    const double left = std::max(0.0, std::sqrt(c.fit.chi2) - grows_faster * shape);
    return shape > known_shape
               ? std::optional(all_.log_odds(i, std::max(0.0, chi2_before_ - left * left), all_.class_priors_[i]))
               : std::nullopt;
  }

  const Signature& signature(std::size_t i) const { return all_.signatures_[i]; }
  bool is_known(std::size_t i) const { return known_ && same(*known_, signature(i).effect); }
  bool leaves_much() const {
    double least = chi2_before_;
    for (const Candidate& c : out_)
      if (c.fit.found) least = std::min(least, c.fit.chi2);
    return least > 2 * static_cast<double>(observations_.numbers());
  }
  /// To these data, so that it may explain as much more than its signature says; or the same law at a whole group.
  bool is_same_or_wider(std::size_t i) const {
    return known_ && (all_.classes_[i] == class_of_known_ || is_wider(signature(i).effect, *known_));
  }
  /// Or another law side by side with it: the signature of a little restraint, or play, says little of a large one.
  bool is_near_known(std::size_t i) const {
    const auto is_beside = [&](const effects::PlacedEffect& e) { return !effects::law_in_series(*e.effect); };
    const auto& e = signature(i).effect;
    return is_same_or_wider(i) || (known_ && at_one_place(*known_, e) && is_beside(*known_) && is_beside(e));
  }
  /// It may have the same values.
  bool is_like_known(std::size_t i) const {
    if (!is_same_or_wider(i)) return false;
    return std::ranges::equal(signature(i).effect.effect->parameters, known_->effect->parameters, {},
                              &effects::EffectParameter::name, &effects::EffectParameter::name);
  }
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
      if (sized[i] && !(sized[i]->chi2 < (out_[i].fit.found ? out_[i].fit.chi2 : chi2_before_))) sized[i].reset();
    });
    std::vector<std::size_t> promising;
    for (std::size_t i = 0; i < sized.size(); ++i)
      if (sized[i]) promising.push_back(i);
    fit_in_turn(
        std::move(promising), bar_, all_.threads_,
        [&](std::size_t i) {
          return all_.log_odds(i, 1.5 * (chi2_before_ - sized[i]->chi2) + bent, all_.class_priors_[i]);
        },
        [&](std::size_t i, int within) { fit_from(i, sized[i]->value, within); },
        [&](std::size_t i) { return odds(i); });
  }

  void fit_from(std::size_t i, const std::optional<VectorX>& start, int within) {
    Candidate& c = out_[i];
    Fit now = fit(*geometry_, c.hypothesis, so_far_.values, start, within);
    c.fit = c.fit.found ? better(std::move(c.fit), std::move(now)) : std::move(now);
    if (is_like_known(i))
      c.fit = better(std::move(c.fit), fit(*geometry_, c.hypothesis, so_far_.values, known_->values));
    if (signature(i).effect.effect->place && wants_more_than_there_can_be(c.hypothesis, c.fit))
      c.fit = not_found(fmt::format("its {} runs to the end of what it can be, {:g}",
                                    c.added().effect->parameters.front().name, c.fit.values.tail<1>()(0)));
    judge(i);
  }

  void judge(std::size_t i) {
    Candidate& c = out_[i];
    c.gain = c.fit.found ? std::max(0.0, chi2_before_ - c.fit.chi2) : 0;
    c.log_odds = all_.log_odds(i, c.gain, all_.priors_[i]);
  }

  const Candidates& all_;
  const Observations& observations_;
  const Observations* geometry_ = &observations_;  // in which effects are fitted
  const Hypothesis& before_;
  const Fit& so_far_;
  double chi2_before_;  // of so_far_, in the geometry in which the candidates are compared
  std::optional<effects::EffectInstance> known_;
  std::size_t class_of_known_ = 0;
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
  if (larger_sizes_) round.fit_larger(true);
  round.fit_in_true_geometry();
  return round.result();
}

std::optional<std::vector<Candidate>> Candidates::likelier_if_larger(const Observations& observations,
                                                                     const Hypothesis& before, const Fit& so_far,
                                                                     const std::vector<Candidate>& fitted,
                                                                     bool all) const {
  Round round(*this, observations, before, so_far, {});
  round.take(fitted);
  if (!round.fit_larger(all)) return std::nullopt;
  return round.result();
}

std::vector<Candidate> Candidates::fitted_again(const Observations& o, const Fit& so_far,
                                                const std::vector<Candidate>& fitted,
                                                const std::vector<effects::EffectInstance>& from) const {
  const Hypothesis none;  // the round refers to it
  Round round(*this, o, none, so_far, {});
  round.take(fitted);
  round.fit_again(from);
  return round.result();
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
