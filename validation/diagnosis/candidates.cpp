#include "validation/diagnosis/candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>

#include "msa/base/index.h"
#include "validation/diagnosis/evidence.h"
#include "validation/diagnosis/pairs.h"
#include "validation/parallel/cases.h"
#include "validation/statistics/columns.h"

namespace deflect::diagnosis {
namespace {

constexpr double out_of_question = -1e9;           // ln of the odds of what is there already, or cannot be
constexpr double alike = 0.999;                    // cosine from which signatures are one
constexpr double near_nothing = 6, hopeless = 30;  // gains in χ² that are not looked into
constexpr double bent = 8;                         // that a fit may gain beyond what the signature says, where small
constexpr double of_its_own = 0.05;                // share of a signature that others must leave it

/// Per signature the first one that does all but the same.
std::vector<std::size_t> classes_of(const std::vector<Signature>& all, const MatrixX& inner_products) {
  std::vector<std::size_t> out(all.size());
  const MatrixX between = cosines(all, inner_products);
  for (std::size_t i = 0; i < all.size(); ++i) {
    out[i] = i;
    for (std::size_t k = 0; k < i; ++k)
      if (all[i].amplitudes() == all[k].amplitudes() && all[i].shaped == all[k].shaped &&
          between(as_index(i), as_index(k)) > alike) {
        out[i] = out[k];
        break;
      }
  }
  return out;
}

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

/// What is sure to be less likely than the best by this logarithm is not fitted.
constexpr double far_behind = 6;
/// Fits that are begun together: first one, then twice as many each time, up to this. The next ones are compared with
/// the best of these, so that one that explains nearly all spares most others. The numbers do not depend on the
/// threads, so that the answer does not.
constexpr std::size_t at_once = 8;

/// A candidate to be fitted, and the most that ln of its class's odds can become by it.
struct Promise {
  std::size_t signature;
  double most;
};
constexpr double certain = 1e9;

/// Fits those that can still come near the best, which promise the most first. `fit_one`, given the signature and the
/// number of threads within, returns ln of the odds found. Returns the bar that further ones must exceed.
template <class FitOne>
double fit_in_turn(std::vector<Promise> all, double bar, int threads, const FitOne& fit_one) {
  std::stable_sort(all.begin(), all.end(), [](const Promise& a, const Promise& b) { return a.most > b.most; });
  std::size_t count = 0;
  for (std::size_t from = 0; from < all.size() && all[from].most > bar; from += count) {
    count = std::min({std::max<std::size_t>(1, 2 * count), at_once, all.size() - from});
    // Where few are fitted, one with many starts would keep one thread busy long after the others.
    const int within = count < at_once ? threads : 1;
    std::vector<double> found(count, out_of_question);
    parallel::for_each_case(count, 1, threads, [&](std::size_t k) {
      if (all[from + k].most > bar) found[k] = fit_one(all[from + k].signature, within);
    });
    bar = std::max(bar, *std::max_element(found.begin(), found.end()) - far_behind);
  }
  return bar;
}

/// Physics lets it act to one side only, and the residual asks for the other.
bool wrong_way(const Signature& s, const VectorX& residual) {
  return !s.shaped && s.one_sided && s.start_along(residual) > 0;
}

/// What a fit may gain where the signature says `gain`: little more where one law at a place is nearly proportional.
double can_gain(const Signature& s, double gain) {
  return s.effect.effect->place && !s.shaped ? 1.1 * gain + 3 : 1.2 * gain + bent;
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
      priors_(shared_priors(all, classes_)),
      class_priors_(summed(priors_, classes_)) {}

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

std::vector<Candidate> Candidates::beside(const Observations& observations, const Hypothesis& before, const Fit& so_far,
                                          double least, const std::optional<effects::EffectInstance>& known) const {
  std::vector<Candidate> out(signatures_.size());
  std::vector<char> allowed(out.size(), 1);
  const MatrixX fitted = statistics::orthonormal(so_far.signature);
  const MatrixX proportional = statistics::orthonormal(columns_of_unshaped(before, so_far.signature));
  double best = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Signature& s = signatures_[i];
    Candidate& c = out[i];
    c.hypothesis = before;
    c.hypothesis.push_back(s.effect);
    const bool there = std::any_of(before.begin(), before.end(), [&](const auto& p) { return same(p, s.effect); });
    allowed[i] = !there && own_share(s, proportional) > of_its_own;
    if (allowed[i] && !wrong_way(s, so_far.residual))
      c.gain = std::max(most_gain(s, so_far.residual, fitted), most_gain(s, so_far.residual, proportional));
    best = std::max(best, c.gain);
  }
  // A few directions say less of an effect that parameters shape than of one that is proportional to its size.
  const auto enough = [best](const Signature& s) {
    return std::max(near_nothing, (s.shaped ? 0.1 : 0.5) * best - hopeless);
  };
  const auto fit_one = [&](std::size_t i, int within) {
    Candidate& c = out[i];
    const Signature& s = signatures_[i];
    c.fit = fit(observations, c.hypothesis, so_far.values, guess(s, so_far.residual), within);
    if (known && same(*known, s.effect))
      c.fit = better(std::move(c.fit), fit(observations, c.hypothesis, so_far.values, known->values));
    if (s.effect.effect->place && wants_more_than_there_can_be(c.hypothesis, c.fit))
      c.fit = not_found(fmt::format("its {} runs to the end of what it can be, {:g}",
                                    s.effect.effect->parameters.front().name, c.fit.values.tail<1>()(0)));
    c.gain = c.fit.found ? std::max(0.0, so_far.chi2 - c.fit.chi2) : 0;
    c.log_odds = log_odds(i, c.gain, priors_[i]);
  };
  // Entries first: of the many laws at places only those are fitted that can come near them.
  std::array<std::vector<Promise>, 2> parts;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Signature& s = signatures_[i];
    out[i].log_odds = allowed[i] ? log_odds(i, out[i].gain, priors_[i]) : out_of_question;
    if (!allowed[i] || out[i].gain < enough(s)) continue;
    const bool asked_again = known && same(*known, s.effect);
    parts[s.effect.effect->place ? 1 : 0].push_back(
        {i, asked_again ? certain : log_odds(i, can_gain(s, out[i].gain), class_priors_[i])});
  }
  const std::size_t all = parts[0].size() + parts[1].size();
  std::atomic<std::size_t> done = 0;
  double bar = least;
  for (std::vector<Promise>& part : parts)
    bar = fit_in_turn(std::move(part), bar, threads_, [&](std::size_t i, int within) {
      fit_one(i, within);
      if (progress_) progress_(++done, all);
      return out[i].fit.found ? out[i].log_odds : out_of_question;
    });
  for (Candidate& c : out) c.chi2_per_dof = (so_far.chi2 - c.gain) / static_cast<double>(observations.numbers());
  if (progress_) progress_(1, 1);
  add_up_classes(out);
  return out;
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
  std::vector<TwoCandidates> all(promising.size());
  parallel::for_each_case(promising.size(), 1, threads_, [&](std::size_t k) {
    const auto [first, second, gain_of_first, gain] = promising[k];
    all[k].log_odds = out_of_question;
    const TwoCandidates alone = together(before, so_far, first), other = together(before, so_far, second);
    if (!alone.fit.found || !other.fit.found) return;
    TwoCandidates both = together(alone.hypothesis, alone.fit, second);
    if (!both.fit.found || wants_more_than_there_can_be(both.hypothesis, both.fit)) return;
    const double chi2 = both.fit.chi2, of_second = of_class(second, std::max(0.0, alone.fit.chi2 - chi2)),
                 of_first = of_class(first, std::max(0.0, other.fit.chi2 - chi2));
    if (of_first < each || of_second < each) return;
    both.log_odds = of_class(first, std::max(0.0, so_far.chi2 - alone.fit.chi2)) + of_second;
    all[k] = std::move(both);
  });
  const auto best = std::max_element(
      all.begin(), all.end(), [](const TwoCandidates& a, const TwoCandidates& b) { return a.log_odds < b.log_odds; });
  if (best == all.end() || !(best->log_odds > least)) return std::nullopt;
  return std::move(*best);
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
