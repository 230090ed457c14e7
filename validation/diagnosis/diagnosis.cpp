#include "validation/diagnosis/diagnosis.h"

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/diagnosis/bootstrap.h"
#include "validation/diagnosis/interval.h"
#include "validation/diagnosis/larger_tolerances.h"
#include "validation/diagnosis/left_over.h"
#include "validation/diagnosis/rounds.h"
#include "validation/diagnosis/selection.h"
#include "validation/diagnosis/splitting.h"
#include "validation/statistics/evidence.h"

namespace deflect::diagnosis {
namespace {

constexpr double alarm = 0.02;     // chance above which nothing is called missing
constexpr double much_left = 0.1;  // of the misfit: an unknown law that explains more is told, and not what they leave
constexpr double worth_limits = 0.01;   // probability of a candidate
constexpr double half_of_it = 0.5;      // of what others leave: an effect that leaves more explains too little
constexpr double even_hopeless = -1e6;  // ln of odds: every candidate is looked into
constexpr double sure = 0.7, rather_nothing = 0.5;  // probabilities: something unknown is there, nothing is missing
constexpr double unknown_beside = Candidates::prior_unknown / (1 - Candidates::prior_unknown);  // odds
constexpr int most_rounds = 3;

Quality quality(const Observations& o, const Hypothesis& h, const Fit& f) {
  Quality q;
  q.chi2_per_dof = f.chi2 / std::max(1.0, static_cast<double>(o.numbers()) - static_cast<double>(f.values.size()));
  const subject::Subject subject = subject_with(o, h, f.values);
  q.rmse = o.rmse(subject);
  q.held_out = o.held_out_rmse(subject);
  return q;
}

/// Probabilities of the first step's candidates and of "nothing", beside that of "unknown".
void weigh(Diagnosis& d, const LargerTolerances& larger, double unknown, double together = not_several) {
  const std::vector<double> probability = statistics::normalised(log_weights(d.candidates, larger, together));
  const std::size_t count = d.candidates.size();
  for (std::size_t i = 0; i < count; ++i) d.candidates[i].probability = (1 - unknown) * probability[i];
  d.probability_larger_tolerances = (1 - unknown) * probability[count];
  d.probability_nothing = (1 - unknown) * (probability[count] + probability[count + 1]);
  d.probability_unknown = unknown;
}

/// Of what is left unexplained: its size, its pattern, where it acts, the entry that comes nearest.
void describe_left_over(Diagnosis& d, const Weighed& known, const Selection& found,
                        const std::vector<Localised>& instead, int threads) {
  const auto numbers = static_cast<double>(found.observations.numbers());
  const double left = std::max(1.0, found.fit.chi2 - numbers);
  d.share_unexplained = left / std::max(left, found.observations.null_residual().squaredNorm() - numbers);
  d.localised = localised(at_places(known, found.effects, found.fit, threads), found.fit.chi2, numbers);
  const bool of_these = !instead.empty() && !found.effects.empty();
  const bool rather = of_these && (d.localised.empty() || d.share_unexplained > much_left);
  if (rather) d.localised = instead;
  d.pattern = pattern_left(found, d.localised, rather);
  const auto [entry, gain] = nearest_entry(known, found.fit);
  d.nearest = entry;
  d.nearest_share = std::min(1.0, gain / left);
}

void sort_candidates(Diagnosis& d) {
  std::stable_sort(d.candidates.begin(), d.candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.log_odds > b.log_odds; });
}

/// What the data cannot tell apart, and the reading that would.
void note_ties(Diagnosis& d, const Selection& found, const measurement::Measurements& data) {
  for (const Tie& tie : found.ties) {
    if (tie.names.empty()) continue;
    d.indistinguishable.push_back(tie.names);
    d.ties.push_back(tie);
    if (auto split = splitting_reading(found.observations, data, tie)) d.splitting.push_back(std::move(*split));
  }
}

/// Values and limits of what was found alone, and of what ties with it, weighed for each; beside what else was found
/// limits, where derivatives do not tell them. Then how well the candidates that were fitted predict.
void weigh_values(Diagnosis& d, const Observations& o, const Observations& seen, int threads) {
  for (Tie& tie : d.ties)
    for (Candidate& c : tie.rivals)
      if (says_nothing_of_last(c.fit)) c.fit = with_intervals(seen, c.hypothesis, std::move(c.fit), threads);
  for (Candidate& c : d.candidates) {
    const bool ties = std::any_of(d.indistinguishable.begin(), d.indistinguishable.end(), [&](const auto& group) {
      return std::find(group.begin(), group.end(), c.added().effect->name) != group.end();
    });
    const bool alone = d.missing.size() == 1;
    if (alone && ties && c.fit.found && c.probability > worth_limits)
      c.fit = weighed_for_itself(seen, c.hypothesis, c.fit, threads);
    else if (alone && same(c.added(), d.missing.front()))
      c.fit = d.fit;
    else if (ties && c.probability > worth_limits && c.fit.limits.empty())
      c.fit = with_intervals(o, c.hypothesis, std::move(c.fit), threads);
    const Quality q = c.fit.found ? quality(o, c.hypothesis, c.fit) : d.baseline;
    c.rmse = q.rmse, c.held_out = q.held_out;
  }
}

/// What there is to be said where the file is not what it seems.
Diagnosis only_mistakes(Diagnosis d, const Observations& o) {
  d.verdict = Verdict::unknown_effect;
  d.probability_unknown = 1;
  d.fit = fit_of_all(o, {}, VectorX(0));
  d.baseline = d.final = quality(o, {}, d.fit);
  d.unexplained = true;
  d.share_unexplained = 1;
  d.pattern = d.mistakes.front().sentence;
  return d;
}

/// What is known before any effect is tried.
Diagnosis before_any_effect(const Observations& o, const measurement::Measurements& data) {
  Diagnosis d;
  d.device = o.subject().name();
  d.data = data.origin;
  d.how_read = data.how_read;
  d.mistakes = o.comparison().mistakes;
  d.readings = o.comparison().readings;
  d.set_aside = o.set_aside();
  d.quantity = compare::quantity_of_errors(o.comparison().study.values);
  d.noise_floor = o.comparison().sigma_u;
  d.tolerance_scale = o.tolerance_scale();
  return d;
}

/// Every effect alone, and whether anything is missing at all.
struct FirstStep {
  FirstStep(const Observations& o, SignaturesAtPlaces signed_effects, int bootstrap_sets, Rounds& rounds,
            const parallel::Work& work)
      : observations(o),
        signatures(std::move(signed_effects)),
        candidates(all(), work.threads, [&](std::size_t done, std::size_t of) { rounds(done, of); }),
        null(fit_of_all(o, {}, VectorX(0))),
        each(candidates.beside(o, {}, null, even_hopeless)),
        left(left_over(o.whitened_patterns(), at_places(signatures.known(), {}, null, work.threads), null)),
        larger(larger_tolerances(o)),
        chance(chance_of_any(all(), candidates.between(), least_p_value(all(), each), bootstrap_sets, work,
                             [&](std::size_t done, std::size_t of) { rounds(done, of); })) {}
  FirstStep(const FirstStep&) = delete;  // the candidates hold the signatures by reference

  double probability_of_unknown_alone(const std::vector<Candidate>& alone) const {
    constexpr double missing_odds = Candidates::prior_missing / (1 - Candidates::prior_missing);
    return statistics::probability_of(left.log_evidence - statistics::log_sum_exp(log_weights(alone, larger)),
                                      missing_odds * Candidates::prior_unknown);
  }

  const std::vector<Signature>& all() const { return signatures.all(); }

  const Observations& observations;
  SignaturesAtPlaces signatures;
  Candidates candidates;
  Fit null;
  std::vector<Candidate> each;  // in the order of the signatures
  LeftOver left;
  LargerTolerances larger;
  double chance;
};

/// What the first step says of the effects, of "nothing" and of "unknown"; `alone`: its candidates, or larger ones.
void tell(Diagnosis& d, const FirstStep& s, std::vector<Candidate> alone) {
  d.left_out = s.signatures.left_out();
  d.detectable = detectable_sizes(s.all(), cosines(s.all(), s.candidates.between()));
  d.baseline = quality(s.observations, {}, s.null);
  d.larger_tolerances = s.larger.scale * s.observations.tolerance_scale();
  d.chance = s.chance;
  d.candidates = std::move(alone);
  weigh(d, s.larger, s.probability_of_unknown_alone(d.candidates));
}

bool is_missing(const Diagnosis& d, const FirstStep& s) {
  return (d.chance < alarm && d.probability_nothing < rather_nothing) ||
         (d.probability_unknown > sure && s.left.p_value < LeftOver::least_p);
}

/// Whether larger tolerances stand for "nothing" and no single effect is likelier. Several together may be.
bool is_missing_or_larger(const Diagnosis& d) {
  return d.chance < alarm && d.probability_larger_tolerances > 0.5 * d.probability_nothing;
}

/// The effects that explain the data best, and what they leave.
struct Explained {
  Selection found;
  LeftOver left;
  std::size_t granted = 0;  ///< effects that counted as right
  /// Whitened with what the effects have changed; hundreds of columns, so kept only where `left` is significant.
  std::shared_ptr<const WhitenedFamilies> patterns = nullptr;
};

Explained nothing(const FirstStep& s) { return {{s.observations, {}, s.null, {}, {}}, {}}; }

Explained explained(const FirstStep& s, const Candidates& candidates, const std::vector<Candidate>& first) {
  const auto places_of = [&](const Selection& found) {
    return by_places({s.signatures, found.observations}, found, candidates.threads());
  };
  const auto enough = [&](const Selection& f) { return is_all_at_one_place(places_of(f), candidates, f); };
  Explained out{select(s.observations, candidates, first, enough), {}};
  out.granted = out.found.effects.size();
  const ByPlaces places = places_of(out.found);
  out.patterns = out.found.observations.whitened_patterns();
  out.left = left_over(out.patterns, places.beside, out.found.fit);
  const double more = out.left.significant() ? 0 : clearly_one_place;
  if (std::optional<AllAtOnePlace> at = at_one_place(places, candidates, out.found, more)) {
    out.found = std::move(at->there);
    if (!at->all_there) out.left = left_over(out.patterns, places_of(out.found).beside, out.found.fit);
    if (out.left.significant())
      out.left.instead = std::move(at->instead.instead);
    else if (at->all_there)
      out.left = std::move(at->instead);
  }
  if (!out.left.significant()) out.patterns.reset();
  return out;
}

/// ln(prior · evidence) of effects, as they were fitted to these observations, against nothing.
double log_odds_of(const FirstStep& s, const Observations& o, const Hypothesis& h, const Fit& f) {
  const bool same_readings = o.aside() == s.observations.aside();
  const double more =
      log_likelihood(o, h, f.values) - log_likelihood(same_readings ? s.observations : o, {}, VectorX(0));
  return log_odds_of_all(s.candidates, h, 2 * more);
}

/// The same of all that was found, something unknown included.
double log_odds_of_all(const FirstStep& s, const Explained& e) {
  return log_odds_of(s, e.found.observations, e.found.effects, e.found.fit) +
         (e.left.significant() ? e.left.log_evidence + std::log(unknown_beside) : 0);
}

/// The same where it is several.
double log_odds_together(const FirstStep& s, const Explained& e) {
  const bool several = e.found.effects.size() > 1 || (!e.found.effects.empty() && e.left.significant());
  return several ? log_odds_of_all(s, e) : not_several;
}

/// Whether several effects together are likelier than larger tolerances, though none alone is.
bool outweigh_larger_tolerances(const Explained& e, const FirstStep& s) {
  return statistics::normalised({log_odds_together(s, e), s.larger.log_odds, 0}).front() > 1 - rather_nothing;
}

/// Effects are looked for from small sizes. Where several were found, or more than noise is left: what is found from a
/// large size, if it leaves nothing unknown and, where the others do not either, is likelier; returns the candidates
/// for the first effect then.
std::optional<std::vector<Candidate>> look_for_large_ones(Explained& e, const FirstStep& s) {
  const Observations& o = s.observations;
  const double by_noise = statistics::most_by_noise(static_cast<double>(o.numbers()));
  if (!e.left.significant() && e.found.effects.size() < 2 && e.found.fit.chi2 <= by_noise) return std::nullopt;
  auto large = s.candidates.likelier_if_larger(o, {}, s.null, s.each, e.left.significant());
  if (!large) return std::nullopt;
  const auto best = std::max_element(large->begin(), large->end(), [](const Candidate& a, const Candidate& b) {
    return a.class_log_odds < b.class_log_odds;
  });
  const auto left = [&](const Fit& f) { return f.chi2 - static_cast<double>(o.numbers()); };
  const Observations weighed = o.weighed_for(subject_with(o, best->hypothesis, best->fit.values));
  const Fit alone = fit_of_all(weighed, best->hypothesis, best->fit.values);
  if (e.left.significant() ? left(alone) > half_of_it * left(e.found.fit)
                           : log_odds_of(s, weighed, best->hypothesis, alone) < log_odds_of_all(s, e))
    return std::nullopt;
  Explained again = explained(s, s.candidates.in_larger_sizes(), *large);
  if (again.left.significant()) return std::nullopt;
  if (!e.left.significant() && log_odds_of_all(s, again) < log_odds_of_all(s, e)) return std::nullopt;
  e = std::move(again);
  return large;
}

Verdict verdict_of(const Diagnosis& d) {
  if (d.unexplained) return Verdict::unknown_effect;
  if (d.missing.empty()) return Verdict::nothing_missing;
  return d.indistinguishable.empty() ? Verdict::effect : Verdict::ambiguous;
}

/// With the observations in which all that it names, and nothing else, counts as right, where they are at hand.
struct Diagnosed {
  Diagnosis diagnosis;
  std::optional<Observations> seen = std::nullopt;
};

/// What was found and what it leaves. `told`: the first step that the diagnosis tells of.
Diagnosed conclude(Diagnosis d, Explained e, const FirstStep& told, const measurement::Measurements& data,
                   int threads) {
  const double together = log_odds_together(told, e);
  Selection found = std::move(e.found);
  // A search that went by another effect can find a better fit of one than the first step did.
  d.candidates = told.candidates.fitted_again(told.observations, told.null, d.candidates, as_fitted(found));
  d.unexplained = e.left.significant();
  d.log_odds_unknown = e.left.log_evidence + std::log(unknown_beside);
  if (!found.effects.empty())
    weigh(d, told.larger, statistics::probability_of(e.left.log_evidence, unknown_beside), together);
  // In the first step something unknown counts for more than beside what was found: there nothing may be likelier.
  if (!d.unexplained && d.probability_nothing >= rather_nothing) found = nothing(told).found;
  sort_candidates(d);
  if (d.unexplained) {
    const Weighed known(told.signatures, found.observations);
    found = named_beside_unknown(e.patterns, known, told.candidates, std::move(found));
    e.patterns.reset();
    describe_left_over(d, known, found, e.left.instead, threads);
  }
  const Observations& seen = found.observations;
  d.missing = found.effects;
  d.fit = weighed_for_itself(seen, d.missing, found.fit, threads);
  d.left_out.insert(d.left_out.end(), found.left_out.begin(), found.left_out.end());
  add_left_out(d.left_out, told.each);
  note_ties(d, found, data);
  weigh_values(d, told.observations, seen, threads);
  d.verdict = verdict_of(d);
  d.final = quality(seen, d.missing, d.fit);
  d.strained = seen.strained(subject_with(seen, d.missing, d.fit.values));
  d.set_aside = seen.set_aside();
  d.in_play = seen.in_play();
  if (d.missing.size() != e.granted) return {std::move(d)};
  return {std::move(d), std::move(found.observations)};
}

/// Than the one that was found, if it is one, with other readings set aside.
bool is_another_likelier(const std::vector<Candidate>& all, const Selection& found) {
  const auto own =
      std::find_if(all.begin(), all.end(), [&](const auto& c) { return is_among(found.effects, c.added()); });
  return found.effects.size() == 1 && own != all.end() &&
         std::any_of(all.begin(), all.end(), [&](const auto& c) { return c.class_log_odds > own->class_log_odds; });
}

Diagnosed diagnosed(const Observations& o, const measurement::Measurements& data,
                    const std::vector<effects::Effect>& effects, const DiagnosisOptions& options,
                    const parallel::Work& work) {
  Diagnosis d = before_any_effect(o, data);
  if (is_mistaken(d)) return {only_mistakes(std::move(d), o)};
  d.bootstrap_sets = options.bootstrap_sets;
  Rounds rounds(work.progress, 0.3);
  std::optional<FirstStep> step;
  step.emplace(o, SignaturesAtPlaces(o, effects, work.threads), options.bootstrap_sets, rounds, work);
  tell(d, *step, step->each);
  Explained e = nothing(*step);
  std::optional<std::vector<Candidate>> large;
  if (is_missing(d, *step)) {
    e = explained(*step, step->candidates, step->each);
    large = look_for_large_ones(e, *step);
    if (large) tell(d, *step, *large);
  } else if (is_missing_or_larger(d)) {
    Explained several = explained(*step, step->candidates, step->each);
    if (outweigh_larger_tolerances(several, *step)) e = std::move(several);
  }
  if (e.found.observations.aside() == o.aside()) return conclude(std::move(d), std::move(e), *step, data, work.threads);
  // A gross outlier where nothing is missing may be none beside what was found, and the reverse: all is asked anew.
  const Observations kept = o.keeping(e.found.observations.aside());
  parallel::Work again = work;
  again.journal = nullptr;  // it holds sets of the first
  SignaturesAtPlaces weighed = std::move(step->signatures);
  weighed.weigh_for(kept, work.threads);
  step.emplace(kept, std::move(weighed), options.bootstrap_sets, rounds, again);
  const Candidates candidates = large ? step->candidates.in_larger_sizes() : step->candidates;
  tell(d, *step, large ? candidates.beside(kept, {}, step->null, even_hopeless) : step->each);
  const bool stays = is_missing(d, *step) || outweigh_larger_tolerances(e, *step);
  if (stays && is_another_likelier(d.candidates, e.found)) e = explained(*step, candidates, d.candidates);
  return conclude(std::move(d), stays ? std::move(e) : nothing(*step), *step, data, work.threads);
}

/// How large tolerances look beside what was found.
double scale_beside(const Observations& o, Diagnosed& found) {
  const Diagnosis& d = found.diagnosis;
  if (d.missing.empty()) return o.tolerance_scale();
  const subject::Subject right = subject_with(o, d.missing, d.fit.values);
  if (!found.seen) found.seen = o.granted(right);
  return tolerance_scale_beside(*found.seen, right, d.unexplained ? std::optional(d.log_odds_unknown) : std::nullopt);
}

}  // namespace

bool is_mistaken(const Diagnosis& d) { return !d.mistakes.empty() && d.mistakes.front().certain; }

Diagnosis diagnose(const subject::Subject& subject, const measurement::Measurements& data,
                   const std::vector<effects::Effect>& effects, const DiagnosisOptions& options,
                   const parallel::Work& work) {
  DiagnosisOptions asked = options;
  parallel::Work again = work;
  std::vector<compare::RecordingMistake> mistakes;
  double tolerances = 1;  // times as declared
  for (int round = 1;; ++round) {
    const Observations o(subject, data, asked.comparison, again.part(0, 0.2), tolerances);
    Diagnosed found = diagnosed(o, data, effects, asked, again);
    Diagnosis& d = found.diagnosis;
    if (round == 1) mistakes = d.mistakes;
    d.mistakes = mistakes;
    if (round == most_rounds) return std::move(d);
    // Noise that nobody tells was read off what no pattern explains; what was found may have been part of it.
    // Tolerances may be larger than declared beside what was found. Whether the data are right has been settled.
    std::vector<double> sigma;
    if (!d.missing.empty())
      sigma = noise_beside(o.comparison(), subject_with(o, d.missing, d.fit.values), data, asked.comparison, work);
    const double beside = sigma.empty() ? scale_beside(o, found) : tolerances;
    if (sigma.empty() && beside == tolerances) return std::move(d);
    if (!sigma.empty()) asked.comparison.sigma = std::move(sigma);
    tolerances = beside;
    asked.comparison.as_recorded = true;
    again = work.quiet();
    again.journal = nullptr;  // it holds sets of the first
  }
}

}  // namespace deflect::diagnosis
