#include "validation/diagnosis/left_over.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "validation/compare/findings.h"
#include "validation/effects/edit_paths.h"
#include "validation/effects/place_effects.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/evidence.h"
#include "validation/statistics/tail.h"

namespace deflect::diagnosis {
namespace {

// Times the misfit with all effects: without any of them, for them to be most of the matter; then without one of them.
constexpr double large_part = 4, small_part = 1.25;
constexpr double nearly_all = 0.95;
constexpr double clearly_more_noise = 1.1;  // times the σ that is given
constexpr double small_rest = 0.02;         // of χ²: what a curve leaves of a law with knees

/// The likeliest place.
const AtPlace* likeliest(const std::vector<AtPlace>& places) {
  const AtPlace* out = nullptr;
  double most = -INFINITY;
  for (const AtPlace& p : places)
    if (const double l = p.log_odds(); l > most) most = l, out = &p;
  return out;
}

/// Entries of the catalogue have no place: they are at the part that they edit. At a load or a sensor what may be wrong
/// holds all that they do.
bool at_the_same_part(const effects::PlacedEffect& e, const subject::Place& p, const Observations& o) {
  if (e.effect->place) return subject::of_one_part(*e.effect->place, p);
  return p.kind != subject::PlaceKind::load && p.kind != subject::PlaceKind::sensor &&
         effects::edits_only(*e.effect, p.path, o.subject());
}

/// Whether an unknown law at another place takes what this effect explains: with the effect and a law at a place the
/// readings are not clearly likelier than with a law at a place alone.
bool is_a_law_elsewhere(const effects::PlacedEffect& e, const Selection& with, const Hypothesis& others,
                        const Fit& without, const Weighed& all, const Candidates& candidates) {
  const std::vector<AtPlace> alone = at_places(all, others, without, candidates.threads());
  const AtPlace* place = likeliest(alone);
  if (!place || at_the_same_part(e, place->place(), with.observations)) return false;
  const double more = log_evidence(at_places(all, with.effects, with.fit, candidates.threads())) - log_evidence(alone);
  return candidates.class_log_odds_of(e, std::max(0.0, without.chi2 - with.fit.chi2)) + more < clearly;
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

/// Of a law at these places, of which nothing is left beside it and which is as likely nowhere else; else empty.
std::string at_places_alone(const std::vector<Localised>& places, bool instead) {
  double sum = 0, least = 1;
  std::vector<std::string> at;
  for (const Localised& l : places) {
    subject::Place place = l.place;
    if (l.leg) place.leg = l.leg;
    sum += l.probability, least = std::min(least, l.share);
    at.push_back(effects::words_of(place));
  }
  if (sum < nearly_all || (least < nearly_all && !instead)) return "";
  return fmt::format("an unknown law at one place {}: {}",
                     instead ? "explains more than these do" : fmt::format("takes {:.0f} % of it", 100 * least),
                     fmt::join(at, " or "));
}

}  // namespace

std::pair<std::string, double> nearest_entry(const Weighed& all, const Fit& fit) {
  const MatrixX fitted = statistics::orthonormal(fit.signature);
  std::pair<std::string, double> out;
  for (const Signature& s : all.all().laws) {
    if (s.effect.effect->place) continue;
    if (const double gain = most_gain(all.law(s), fit.residual, fitted); gain > out.second)
      out = {name_of(s.effect), gain};
  }
  return out;
}

std::string pattern_left(const Selection& found, const std::vector<Localised>& places, bool instead) {
  const auto has_effect = [&](const Localised& l) {
    return std::any_of(found.effects.begin(), found.effects.end(), [&](const effects::PlacedEffect& e) {
      return at_the_same_part(e, l.place, found.observations);
    });
  };
  if (instead || std::none_of(places.begin(), places.end(), has_effect))
    if (std::string all = at_places_alone(places, instead && !found.effects.empty()); !all.empty()) return all;
  const Observations& o = found.observations;
  const subject::Subject subject = subject_with(o, found.effects, found.fit.values);
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

LeftOver left_over(const std::shared_ptr<const WhitenedFamilies>& patterns, const std::vector<AtPlace>& places,
                   const Fit& fit) {
  const Discrepancy common(patterns, fit.signature);
  return {statistics::log_mean_exp({common.log_evidence(fit.residual), log_evidence(places)}),
          std::min(1.0, 2 * std::min(common.p_value(fit.residual), p_value(places)))};
}

ByPlaces by_places(const Weighed& all, const Selection& s, int threads) {
  ByPlaces out{fit_of_all(s.observations, {}, VectorX(0)), {}, {}};
  const Hypothesis none;
  std::vector<Fitted> fits = {{none, out.null}};
  if (!s.effects.empty()) fits.push_back({s.effects, s.fit});
  std::vector<std::vector<AtPlace>> places = at_places(all, fits, threads);
  out.beside = std::move(places.back());
  out.alone = s.effects.empty() ? out.beside : std::move(places.front());
  return out;
}

namespace {

/// An unknown law at one place against the effects of a selection and an unknown law beside them.
struct OnePlace {
  const subject::Place* place = nullptr;  ///< null where there is none
  double left = 0, of = 0;                ///< χ² beside it, and without anything
  double likelier = 0, p_value = 1;       ///< than the effects and an unknown law beside them
  std::vector<Localised> places = {};     ///< shares are of all of χ² beyond noise
};

OnePlace one_place(const ByPlaces& by_places, const Candidates& candidates, const Selection& s) {
  const auto& [null, alone, beside] = by_places;
  const AtPlace *place = likeliest(alone), *further = likeliest(beside);
  if (!place) return {};
  const AtPlace::Span& most = place->most();
  const double left = std::min(null.chi2 - most.gain, s.fit.chi2 - (further ? further->most().gain : 0));
  const double noise = std::max(1.0, left / std::max(1.0, static_cast<double>(s.observations.numbers())));
  const double found = log_odds_of_all(candidates, s.effects, (null.chi2 - s.fit.chi2) / noise) +
                       (further ? std::max(0.0, further->log_odds(noise)) : 0);
  const double likelier = place->log_odds(noise) - found;
  const double beyond = std::max(0.0, most.gain - (null.chi2 - s.fit.chi2)) / noise;
  const auto freedom = std::max<Eigen::Index>(1, most.dimension - s.fit.signature.cols());
  const double p_value = std::exp(most.log_ways) * statistics::chi_squared_tail(freedom, beyond) / place->prior;
  return {&place->place(),
          null.chi2 - most.gain,
          null.chi2,
          likelier,
          std::min(1.0, p_value),
          localised(alone, null.chi2, static_cast<double>(s.observations.numbers()))};
}

/// As shares of what effects with that χ² leave.
std::vector<Localised> beside_these(std::vector<Localised> places, double null, double left, double numbers) {
  for (Localised& l : places)
    l.share = std::clamp((left - null + l.share * (null - numbers)) / std::max(1.0, left - numbers), 0.0, 1.0);
  return places;
}

}  // namespace

std::optional<AllAtOnePlace> at_one_place(const ByPlaces& places, const Candidates& candidates, const Selection& s,
                                          double more) {
  const OnePlace one = s.effects.empty() ? OnePlace{} : one_place(places, candidates, s);
  if (!one.place) return std::nullopt;
  AllAtOnePlace out{s, {one.likelier, one.p_value}};
  for (std::size_t i = s.effects.size(); i-- > 0;) {
    if (at_the_same_part(s.effects[i], *one.place, s.observations)) continue;
    auto [others, values] = without(out.there.effects, out.there.fit.values, i);
    out.there.effects = std::move(others);
    out.there.fit.values = std::move(values);
    if (i < out.there.ties.size()) out.there.ties.erase(out.there.ties.begin() + as_index(i));
  }
  out.all_there = out.there.effects.size() == s.effects.size();
  if (out.all_there ? !out.instead.significant() : one.likelier < more) return std::nullopt;
  if (!out.all_there) out.there.fit = fit_of_all(s.observations, out.there.effects, out.there.fit.values);
  if (!out.there.fit.found) return std::nullopt;
  out.instead.instead =
      beside_these(one.places, one.of, out.there.fit.chi2, static_cast<double>(s.observations.numbers()));
  return out;
}

bool is_all_at_one_place(const ByPlaces& places, const Candidates& candidates, const Selection& s) {
  const OnePlace one = one_place(places, candidates, s);
  if (!one.place || one.likelier < clearly_one_place) return false;
  const bool others = std::any_of(s.effects.begin(), s.effects.end(),
                                  [&](const auto& e) { return !at_the_same_part(e, *one.place, s.observations); });
  return one.left <
         statistics::most_by_noise(static_cast<double>(s.observations.numbers())) + (others ? small_rest * one.of : 0);
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
                           candidates.class_log_odds_of(s.effects[i], std::max(0.0, gain)) <= clearly;
    if (!is_common && !is_a_law_elsewhere(s.effects[i], s, others, rest, all, candidates)) continue;
    s.effects = std::move(others);
    s.fit = std::move(rest);
    if (i < s.ties.size()) s.ties.erase(s.ties.begin() + as_index(i));
  }
  return s;
}

}  // namespace deflect::diagnosis
