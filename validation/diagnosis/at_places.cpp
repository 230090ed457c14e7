#include "validation/diagnosis/at_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "msa/base/index.h"
#include "validation/effects/place_effects.h"
#include "validation/parallel/cases.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/evidence.h"
#include "validation/statistics/tail.h"

namespace deflect::diagnosis {
namespace {

constexpr double left_of_a_column = 1e-3;  // of a unit column beside the fit: less is rounding
constexpr double together_told = 0.95;     // probability
constexpr std::size_t looked_into = 6;     // places: the columns are computed each time
constexpr double beyond_chance = 30;       // in χ², of a few hundred that are looked at
constexpr double least_of_a_bend = 6;      // in χ², beyond the most of many by chance
constexpr double nearly_most = 0.9;        // of the gain of the place that gains most

struct LawsAtPlace {
  Spot spot;
  std::vector<const Signature*> laws;
  const PlaceWithoutLaw* without = nullptr;
  double prior = 1;
};

/// In the order of the signatures, then of the places. What can be wrong with a sensor is at one place, whatever it is.
std::vector<LawsAtPlace> laws_by_place(const Explanations& all) {
  std::vector<LawsAtPlace> out;
  std::map<Spot, std::size_t> number;
  for (const Signature& s : all.laws) {
    if (!s.effect.effect->place) continue;
    const Spot spot = spot_of(*s.effect.effect->place, s.effect.leg);
    const auto [at, is_new] = number.emplace(spot, out.size());
    if (is_new) out.push_back({spot, {}});
    out[at->second].laws.push_back(&s);
  }
  for (const PlaceWithoutLaw& p : all.without_law) out.push_back({spot_of(p.place, p.leg), {}, &p});
  std::map<std::string, double> legs;
  for (const LawsAtPlace& p : out)
    if (p.spot.second > 0) legs[p.spot.first] += 1;
  double total = 0;
  for (LawsAtPlace& p : out) {
    if (p.spot.second > 0) p.prior = 1 / legs[p.spot.first];
    total += p.prior;
  }
  for (LawsAtPlace& p : out) p.prior /= total;
  return out;
}

bool has_curve(const LawsAtPlace& p) { return !p.without && p.laws.front()->any_curve; }
bool has_friction(const LawsAtPlace& p) { return !p.without && p.laws.front()->any_friction; }

/// How many may explain it and share its prior: its laws; a few frictions; three kinds of curve, two of them beside its
/// laws. Places with curves count alike, whether they can rub or not.
int spans_of(const LawsAtPlace& p) { return has_curve(p) ? 7 : has_friction(p) ? 2 : 1; }

AtPlace::Span explained_within(const MatrixX& orthonormal, const VectorX& residual) {
  return {(orthonormal.transpose() * residual).squaredNorm(), static_cast<int>(orthonormal.cols())};
}

AtPlace::Span span_of(const std::vector<MatrixX>& columns, const VectorX& residual) {
  if (columns.empty()) return {};
  return explained_within(statistics::orthonormal(statistics::side_by_side(columns, residual.size()), left_of_a_column),
                          residual);
}

/// ln of the number of ways to choose so many.
double log_choices(Eigen::Index of, Eigen::Index chosen) {
  double out = 0;
  for (Eigen::Index i = 0; i < chosen; ++i)
    out += std::log(static_cast<double>(of - i) / static_cast<double>(chosen - i));
  return out;
}

/// Of the columns that gain more in turn than the best of them does by chance.
AtPlace::Span span_of_few(const MatrixX& columns, const VectorX& residual) {
  const double by_chance = least_of_a_bend + 2 * std::log(static_cast<double>(columns.cols()));
  const MatrixX few = statistics::chosen_in_turn(columns, residual, by_chance, left_of_a_column);
  AtPlace::Span out = explained_within(few, residual);
  out.log_ways = log_choices(columns.cols(), few.cols());
  return out;
}

/// What a law at a place can do to the readings, weighed. It takes far longer to find than to compare with a residual.
struct ColumnsAtPlace {
  ColumnsAtPlace(const Weighed& all, const LawsAtPlace& place) {
    Columns of_whatever = nullptr, of_friction = nullptr;
    if (place.without) {
      const PlaceWithoutLaw here = all.place(*place.without);
      of_whatever = here.whatever_the_law, of_friction = here.any_friction;
    }
    for (const Signature* s : place.laws) laws.push_back(all.law(*s));
    if (!laws.empty()) {
      const Signature& first = laws.front();
      of_whatever = first.whatever_the_law, curve = first.any_curve, of_friction = first.any_friction;
    }
    if (of_whatever) whatever = of_whatever();
    if (of_friction) friction = of_friction();
  }

  std::vector<Signature> laws;  ///< in the order of the place's
  std::optional<MatrixX> whatever, friction;
  AnyCurve curve = nullptr;
};

/// By all laws at a place, by a few frictions there, and by any of the curves, alone and, but for finer lines, beside
/// the laws.
AtPlace explained_by(const ColumnsAtPlace& here, const LawsAtPlace& place, const VectorX& residual,
                     const MatrixX& fitted, std::span<const Curves> curves) {
  AtPlace out;
  out.without_law = place.without;
  out.prior = place.prior / spans_of(place);
  double most = -1;
  std::vector<MatrixX> columns;
  const auto add = [&](const MatrixX& basis) {
    const MatrixX beside = basis - fitted * (fitted.transpose() * basis);
    for (const auto column : beside.colwise())
      if (column.norm() > left_of_a_column) columns.emplace_back(column);
  };
  for (std::size_t i = 0; i < here.laws.size(); ++i) {
    const Signature& law = here.laws[i];
    add(law.basis);
    const double gain = most_gain(law, residual, fitted);
    if (gain <= most) continue;
    most = gain, out.best = place.laws[i];
    out.other_way = law.one_sided && law.start_along(residual) > 0;
  }
  if (here.whatever) add(*here.whatever);
  out.spans.push_back(span_of(columns, residual));
  const std::vector<MatrixX> laws = std::move(columns);
  const auto few_of = [&](const MatrixX& basis, bool rubs) {
    columns.clear();
    add(basis);
    if (columns.empty()) return;
    out.spans.push_back(span_of_few(statistics::side_by_side(columns, residual.size()), residual));
    out.spans.back().rubs = rubs;
  };
  if (here.friction) few_of(*here.friction, true);
  for (const Curves kind : curves) {
    if (kind == Curves::finer_lines) {
      few_of(here.curve(kind), false);
      continue;
    }
    columns.clear();
    add(here.curve(kind));
    out.spans.push_back(span_of(columns, residual));
    columns.insert(columns.end(), laws.begin(), laws.end());
    out.spans.push_back(span_of(columns, residual));
  }
  std::erase_if(out.spans, [](const AtPlace::Span& s) { return s.dimension == 0; });
  return out;
}

/// Of those that have curves: where the laws explain most, and the places of the effects, whose laws are used up.
std::vector<std::size_t> worth_any_curve(const std::vector<LawsAtPlace>& places, const std::vector<AtPlace>& by_laws,
                                         const Hypothesis& effects) {
  const auto has_effect = [&](const LawsAtPlace& p) {
    return std::any_of(effects.begin(), effects.end(), [&](const effects::PlacedEffect& e) {
      return e.effect->place && spot_of(*e.effect->place, e.leg) == p.spot;
    });
  };
  std::vector<std::size_t> out, others;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (has_curve(places[i])) (has_effect(places[i]) ? out : others).push_back(i);
  const auto gain = [&](std::size_t i) { return by_laws[i].spans.empty() ? 0 : by_laws[i].most().gain; };
  std::stable_sort(others.begin(), others.end(), [&](std::size_t a, std::size_t b) { return gain(a) > gain(b); });
  others.resize(std::min(looked_into, others.size()));
  out.insert(out.end(), others.begin(), others.end());
  return out;
}

/// Of those at which curves were tried: the ones that explain nearly as much as any, where that leaves more than noise.
std::vector<std::size_t> worth_finer_lines(const std::vector<std::size_t>& curved, const std::vector<AtPlace>& places,
                                           const Fit& fit) {
  const auto gain = [&](std::size_t i) { return places[i].spans.empty() ? 0 : places[i].most().gain; };
  double most = 0;
  for (const std::size_t i : curved) most = std::max(most, gain(i));
  std::vector<std::size_t> out;
  if (fit.chi2 - most < statistics::most_by_noise(static_cast<double>(fit.residual.size()))) return out;
  std::copy_if(curved.begin(), curved.end(), std::back_inserter(out),
               [&](std::size_t i) { return gain(i) > nearly_most * most; });
  return out;
}

/// The title of the likeliest law in the middle of a sentence, with the leg's number where it is one.
std::string words_of(const AtPlace& p) {
  if (!p.best || p.most().rubs) {
    subject::Place place = p.place();
    place.leg = p.best ? p.best->effect.leg : p.without_law->leg;
    const bool reads = !subject::sensor_of(place).empty();
    return effects::words_of(place) + (!p.most().rubs ? ", by none of the laws"
                                       : reads        ? ", which sticks"
                                                      : ", where something rubs");
  }
  const effects::PlacedEffect& e = p.best->effect;
  std::string out = e.effect->title;
  out.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(out.front())));
  const std::string one = "of one leg";
  if (const std::size_t at = out.find(one); e.leg && at != out.npos)
    out.replace(at, one.size(), fmt::format("of leg {}", *e.leg));
  if (p.other_way) out += ", the other way: the machine yields less there than the model";
  return out;
}

}  // namespace

Weighed::Weighed(const SignaturesAtPlaces& s, const Observations& o) : all_(&s.known()) {
  if (s.are_weighed_for(o)) return;
  signatures_ = &s;
  observations_ = std::make_shared<const Observations>(o);
}

Signature Weighed::law(const Signature& s) const {
  return signatures_ ? signatures_->law_seen_by(observations_, as_size(&s - all_->laws.data())) : s;
}

PlaceWithoutLaw Weighed::place(const PlaceWithoutLaw& p) const {
  return signatures_ ? signatures_->seen_by(observations_, p) : p;
}

std::vector<std::vector<AtPlace>> at_places(const Weighed& all, const std::vector<Fitted>& beside, int threads) {
  std::vector<MatrixX> fitted;
  for (const auto& [effects, fit] : beside)
    fitted.push_back(fit.signature.cols() > 0 ? statistics::orthonormal(fit.signature)
                                              : MatrixX(fit.residual.size(), 0));
  const std::vector<LawsAtPlace> places = laws_by_place(all.all());
  std::vector<std::vector<AtPlace>> out(beside.size(), std::vector<AtPlace>(places.size()));
  parallel::for_each_case(places.size(), 1, threads, [&](std::size_t i) {
    const ColumnsAtPlace here(all, places[i]);
    for (std::size_t k = 0; k < beside.size(); ++k)
      out[k][i] = explained_by(here, places[i], beside[k].fit.residual, fitted[k], {});
  });
  for (std::size_t k = 0; k < beside.size(); ++k) {
    const Fitted& one = beside[k];
    const auto try_curves = [&](const std::vector<std::size_t>& where, std::span<const Curves> curves) {
      parallel::for_each_case(where.size(), 1, threads, [&](std::size_t j) {
        const LawsAtPlace& place = places[where[j]];
        out[k][where[j]] = explained_by({all, place}, place, one.fit.residual, fitted[k], curves);
      });
    };
    const std::vector<std::size_t> curved = worth_any_curve(places, out[k], one.effects);
    try_curves(curved, curves_tried_first);
    try_curves(worth_finer_lines(curved, out[k], one.fit), all_curves);
    std::erase_if(out[k], [](const AtPlace& p) { return p.spans.empty(); });
  }
  return out;
}

std::vector<AtPlace> at_places(const Weighed& all, const Hypothesis& effects, const Fit& fit, int threads) {
  return std::move(at_places(all, {{effects, fit}}, threads).front());
}

const AtPlace::Span& AtPlace::most() const {
  return *std::max_element(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.gain < b.gain; });
}

double AtPlace::log_odds(double noise) const {
  std::vector<double> logs;
  for (const Span& s : spans) logs.push_back(statistics::log_evidence(s.gain / noise, s.dimension, false) - s.log_ways);
  return std::log(prior) + statistics::log_sum_exp(logs);
}

double log_evidence(const std::vector<AtPlace>& all) {
  std::vector<double> logs;
  for (const AtPlace& p : all) logs.push_back(p.log_odds());
  return logs.empty() ? -INFINITY : statistics::log_mean_exp(logs) + std::log(static_cast<double>(logs.size()));
}

double p_value(const std::vector<AtPlace>& all) {
  double out = 1;
  for (const AtPlace& p : all)
    for (const AtPlace::Span& s : p.spans)
      out = std::min(out, std::exp(s.log_ways) * statistics::chi_squared_tail(s.dimension, s.gain) / p.prior);
  return out;
}

std::vector<Localised> localised(const std::vector<AtPlace>& places, double chi2, double numbers, std::size_t most) {
  if (places.empty()) return {};
  AtPlace::Span first;
  for (const AtPlace& p : places)
    if (p.most().gain > first.gain) first = p.most();
  const double scale = std::max(1.0, (chi2 - first.gain) / std::max(1.0, numbers - first.dimension));
  std::vector<double> weights;
  std::vector<std::size_t> order;
  for (const AtPlace& p : places) {
    order.push_back(order.size());
    weights.push_back(p.log_odds(scale));
  }
  const std::vector<double> probability = statistics::normalised(weights);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return probability[a] > probability[b]; });

  const double beyond = std::max(1.0, chi2 - numbers);
  std::vector<Localised> out;
  double sum = 0;
  for (const std::size_t i : order) {
    const AtPlace& p = places[i];
    if (out.size() == most || sum > together_told || p.most().gain < beyond_chance) break;
    sum += probability[i];
    out.push_back({p.place(), p.best ? p.best->effect.leg : p.without_law->leg,
                   p.best && !p.most().rubs ? p.best->effect.effect : nullptr, words_of(p),
                   std::min(1.0, p.most().gain / beyond), probability[i]});
  }
  return out;
}

}  // namespace deflect::diagnosis
