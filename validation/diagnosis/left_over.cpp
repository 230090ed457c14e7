#include "validation/diagnosis/left_over.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "validation/compare/findings.h"
#include "validation/diagnosis/evidence.h"

namespace deflect::diagnosis {
namespace {

// Times the misfit with all effects: without any of them, for them to be most of the matter; then without one of them.
constexpr double large_part = 4, small_part = 1.25;
constexpr double clearly_more_noise = 1.1;  // times the σ that is given

/// The likeliest place.
const AtPlace* likeliest(const std::vector<AtPlace>& places) {
  const AtPlace* out = nullptr;
  double most = -INFINITY;
  for (const AtPlace& p : places)
    if (const double l = std::log(p.prior) + log_evidence(p.gain, p.dimension, false); l > most) most = l, out = &p;
  return out;
}

bool at_the_same_part(const effects::PlacedEffect& e, const subject::Place& p) {
  return e.effect->place && subject::of_one_part(*e.effect->place, p);
}

/// Whether an unknown law at another place takes what this effect explains: with the effect and a law at a place the
/// readings are not clearly likelier than with a law at a place alone.
bool is_a_law_elsewhere(const effects::PlacedEffect& e, const Selection& with, const Hypothesis& others,
                        const Fit& without, const Weighed& all, const Candidates& candidates) {
  const std::vector<AtPlace> alone = at_places(all, others, without, candidates.threads());
  const AtPlace* place = likeliest(alone);
  if (!place || at_the_same_part(e, place->place())) return false;
  const double more = log_evidence(at_places(all, with.effects, with.fit, candidates.threads())) - log_evidence(alone);
  return candidates.class_log_odds_of(e, std::max(0.0, without.chi2 - with.fit.chi2)) + more < called_for;
}

/// The likeliest size of the noise that leaves this residual, in standard deviations as given, 1 or more. Noise s times
/// as large is all as large with tolerances of 1/s: ln L = ln L(r/s; tolerances 1/s) − n ln s.
double likeliest_noise(const statistics::Uncertainty& u, const VectorX& residual) {
  constexpr double step = 1.02, most = 20;
  const auto log_likelihood = [&](double s) {
    return u.log_likelihood_of_scales(residual / s, MatrixX(residual.size(), 0), {1 / s}).front() -
           static_cast<double>(u.count()) * std::log(s);
  };
  double size = 1, likeliest = log_likelihood(1);
  while (size < most) {
    const double next = log_likelihood(step * size);
    if (next <= likeliest) break;
    likeliest = next, size *= step;
  }
  return size;
}

/// What has no pattern may be noise of which the file tells too little.
std::string no_pattern(const Observations& o, const subject::Subject& subject) {
  const std::string none = "no pattern that was looked for";
  if (compare::is_any_estimated(o.comparison())) return none;
  const double size = likeliest_noise(o.uncertainty(), o.residual(subject));
  if (size < clearly_more_noise) return none;
  return fmt::format("{}; noise {:.2g} times as large as the standard deviations that are given would leave as much",
                     none, size);
}

}  // namespace

std::string pattern_left(const Observations& o, const subject::Subject& subject) {
  const compare::ResidualStudy& s = o.comparison().study;
  std::vector<compare::Pattern> patterns = compare::patterns_of(s);
  std::vector<MatrixX> columns;
  for (compare::Pattern& p : patterns) columns.push_back(std::move(p.rows));
  std::string out;
  for (const compare::Finding& f :
       compare::find_patterns(s, o.uncertainty(), o.residual(subject), patterns, columns).findings)
    out += (out.empty() ? "" : "; then ") + f.sentence;
  return out.empty() ? no_pattern(o, subject) : out;
}

LeftOver left_over(const std::shared_ptr<const WhitenedFamilies>& patterns, const Weighed& all,
                   const Hypothesis& fitted, const Fit& fit, int threads) {
  const Discrepancy common(patterns, fit.signature);
  const std::vector<AtPlace> places = at_places(all, fitted, fit, threads);
  return {log_mean_exp({common.log_evidence(fit.residual), log_evidence(places)}),
          std::min(1.0, 2 * std::min(common.p_value(fit.residual), p_value(places)))};
}

namespace {

/// An unknown law at one place against the effects of a selection and an unknown law beside them.
struct OnePlace {
  const subject::Place* place = nullptr;  ///< null where the law is not likelier by what is asked
  double left = 0;                        ///< of χ²
};

OnePlace one_place(const Weighed& all, const Candidates& candidates, const Selection& s, double more) {
  const Fit null = fit_of_all(s.observations, {}, VectorX(0));
  const std::vector<AtPlace> alone = at_places(all, {}, null, candidates.threads()),
                             beside = at_places(all, s.effects, s.fit, candidates.threads());
  const AtPlace *place = likeliest(alone), *further = likeliest(beside);
  if (!place) return {};
  const double left = std::min(null.chi2 - place->gain, s.fit.chi2 - (further ? further->gain : 0));
  const double noise = std::max(1.0, left / std::max(1.0, static_cast<double>(s.observations.numbers())));
  const auto log_odds = [&](const AtPlace& p) {
    return std::log(p.prior) + log_evidence(p.gain / noise, p.dimension, false);
  };
  const double found = log_odds_of_all(candidates, s.effects, (null.chi2 - s.fit.chi2) / noise) +
                       (further ? std::max(0.0, log_odds(*further)) : 0);
  return {log_odds(*place) < found + more ? nullptr : &place->place(), null.chi2 - place->gain};
}

}  // namespace

std::optional<Selection> at_one_place(const Weighed& all, const Candidates& candidates, const Selection& s,
                                      double more) {
  const subject::Place* place = s.effects.empty() ? nullptr : one_place(all, candidates, s, more).place;
  if (!place) return std::nullopt;
  Selection there = s;
  for (std::size_t i = s.effects.size(); i-- > 0;) {
    if (at_the_same_part(s.effects[i], *place)) continue;
    auto [others, values] = without(there.effects, there.fit.values, i);
    there.effects = std::move(others);
    there.fit.values = std::move(values);
    if (i < there.ties.size()) there.ties.erase(there.ties.begin() + as_index(i));
  }
  if (there.effects.size() == s.effects.size()) return std::nullopt;
  there.fit = fit_of_all(s.observations, there.effects, there.fit.values);
  return there.fit.found ? std::optional(std::move(there)) : std::nullopt;
}

bool is_all_at_one_place(const Weighed& all, const Candidates& candidates, const Selection& s) {
  const OnePlace there = one_place(all, candidates, s, clearly_one_place);
  return there.place && there.left < most_by_noise(static_cast<double>(s.observations.numbers()));
}

Selection named_beside_unknown(const std::shared_ptr<const WhitenedFamilies>& patterns, const Weighed& all,
                               const Candidates& candidates, Selection s) {
  const Discrepancy common(patterns), left(patterns, s.fit.signature);
  const Discrepancy::Size size = left.likeliest(s.fit.residual);
  const bool most = s.observations.null_residual().squaredNorm() > large_part * s.fit.chi2;
  const double own_part = most ? small_part : large_part;
  for (std::size_t i = s.effects.size(); i-- > 0;) {
    auto [others, values] = without(s.effects, s.fit.values, i);
    Fit rest = fit_of_all(s.observations, others, values);
    if (!rest.found) continue;  // the others need it
    const double gain = common.chi2(rest.residual, size) - common.chi2(s.fit.residual, size);
    const bool is_common = rest.chi2 <= own_part * s.fit.chi2 &&
                           candidates.class_log_odds_of(s.effects[i], std::max(0.0, gain)) <= called_for;
    if (!is_common && !is_a_law_elsewhere(s.effects[i], s, others, rest, all, candidates)) continue;
    s.effects = std::move(others);
    s.fit = std::move(rest);
    if (i < s.ties.size()) s.ties.erase(s.ties.begin() + as_index(i));
  }
  return s;
}

}  // namespace deflect::diagnosis
