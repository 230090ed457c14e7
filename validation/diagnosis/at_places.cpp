#include "validation/diagnosis/at_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "validation/diagnosis/evidence.h"
#include "validation/parallel/cases.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/tail.h"

namespace deflect::diagnosis {
namespace {

constexpr double left_of_a_column = 1e-3;  // of a unit column beside the fit: less is rounding
constexpr double together_told = 0.95;     // probability
constexpr double half = 0.5;               // of a place's prior: its laws, or any curve
constexpr std::size_t looked_into = 6;     // places; the columns of each are kept
constexpr double beyond_chance = 30;       // in χ², of a few hundred that are looked at

struct LawsAtPlace {
  std::vector<const Signature*> laws;
  double prior = 1;
};

std::string place_of(const effects::PlacedEffect& e) {
  const std::string sensor = subject::sensor_of(*e.effect->place);
  return sensor.empty() ? subject::id_of(*e.effect->place) : "sensors." + sensor;
}

/// In the order of the signatures. What can be wrong with a sensor's channel is at one place, whatever it is.
std::vector<LawsAtPlace> laws_by_place(const std::vector<Signature>& all) {
  std::vector<LawsAtPlace> out;
  std::map<std::pair<std::string, int>, std::size_t> number;
  std::map<std::string, double> legs;
  for (const Signature& s : all) {
    if (!s.effect.effect->place) continue;
    const std::string id = place_of(s.effect);
    const auto [at, is_new] = number.emplace(std::pair(id, s.effect.leg.value_or(0)), out.size());
    if (is_new) out.emplace_back();
    if (is_new && s.effect.leg) legs[id] += 1;
    out[at->second].laws.push_back(&s);
  }
  double total = 0;
  for (LawsAtPlace& p : out) {
    const effects::PlacedEffect& e = p.laws.front()->effect;
    if (e.leg) p.prior = 1 / legs[place_of(e)];
    total += p.prior;
  }
  for (LawsAtPlace& p : out) p.prior /= total;
  return out;
}

/// By all laws at a place, or by any curve there as well.
AtPlace explained_by(const LawsAtPlace& place, const VectorX& residual, const MatrixX& fitted, bool any_curve) {
  AtPlace out;
  const Signature& first = *place.laws.front();
  out.prior = (first.any_curve ? half : 1) * place.prior;
  double most = -1;
  std::vector<MatrixX> columns;
  const auto add = [&](const MatrixX& basis) {
    const MatrixX beside = basis - fitted * (fitted.transpose() * basis);
    for (const auto column : beside.colwise())
      if (column.norm() > left_of_a_column) columns.emplace_back(column);
  };
  for (const Signature* s : place.laws) {
    if (const double gain = most_gain(*s, residual, fitted); gain > most) most = gain, out.best = s;
    add(s->basis);
  }
  if (first.whatever_the_law) add(*first.whatever_the_law);
  if (any_curve) add(first.any_curve->columns());
  out.other_way = out.best->one_sided && out.best->start_along(residual) > 0;
  if (columns.empty()) return out;
  const MatrixX together = statistics::side_by_side(columns, residual.size());
  columns.clear();
  const MatrixX span = statistics::orthonormal(together, left_of_a_column);
  out.dimension = static_cast<int>(span.cols());
  out.gain = (span.transpose() * residual).squaredNorm();
  return out;
}

/// Of those that have curves: where the laws explain most, and the places of the effects, whose laws are used up.
std::vector<std::size_t> worth_any_curve(const std::vector<LawsAtPlace>& places, const std::vector<AtPlace>& by_laws,
                                         const Hypothesis& effects) {
  const auto has_effect = [&](const effects::PlacedEffect& at) {
    return std::any_of(effects.begin(), effects.end(), [&](const effects::PlacedEffect& e) {
      return e.effect->place && e.leg == at.leg && place_of(e) == place_of(at);
    });
  };
  std::vector<std::size_t> out, others;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (const Signature& first = *places[i].laws.front(); first.any_curve)
      (has_effect(first.effect) ? out : others).push_back(i);
  std::stable_sort(others.begin(), others.end(),
                   [&](std::size_t a, std::size_t b) { return by_laws[a].gain > by_laws[b].gain; });
  others.resize(std::min(looked_into, others.size()));
  out.insert(out.end(), others.begin(), others.end());
  return out;
}

/// The effect's title in the middle of a sentence, with the leg's number where it is one.
std::string words_of(const effects::PlacedEffect& e) {
  std::string out = e.effect->title;
  out.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(out.front())));
  const std::string one = "of one leg";
  if (const std::size_t at = out.find(one); e.leg && at != out.npos)
    out.replace(at, one.size(), fmt::format("of leg {}", *e.leg));
  return out;
}

}  // namespace

std::vector<AtPlace> at_places(const std::vector<Signature>& all, const Hypothesis& effects, const Fit& fit,
                               int threads) {
  const MatrixX fitted =
      fit.signature.cols() > 0 ? statistics::orthonormal(fit.signature) : MatrixX(fit.residual.size(), 0);
  const std::vector<LawsAtPlace> places = laws_by_place(all);
  std::vector<AtPlace> out(places.size());
  parallel::for_each_case(places.size(), 1, threads,
                          [&](std::size_t i) { out[i] = explained_by(places[i], fit.residual, fitted, false); });
  const std::vector<std::size_t> curved = worth_any_curve(places, out, effects);
  parallel::for_each_case(curved.size(), 1, threads, [&](std::size_t k) {
    AtPlace& at = out[curved[k]];
    const AtPlace any = explained_by(places[curved[k]], fit.residual, fitted, true);
    if (log_evidence(any.gain, any.dimension, false) > log_evidence(at.gain, at.dimension, false)) at = any;
  });
  std::erase_if(out, [](const AtPlace& p) { return p.dimension == 0; });
  return out;
}

double log_evidence(const std::vector<AtPlace>& all) {
  std::vector<double> logs;
  for (const AtPlace& p : all) logs.push_back(std::log(p.prior) + log_evidence(p.gain, p.dimension, false));
  return logs.empty() ? -INFINITY : log_mean_exp(logs) + std::log(static_cast<double>(logs.size()));
}

double p_value(const std::vector<AtPlace>& all) {
  double out = 1;
  for (const AtPlace& p : all) out = std::min(out, statistics::chi_squared_tail(p.dimension, p.gain) / p.prior);
  return out;
}

std::vector<Localised> localised(const std::vector<AtPlace>& places, double chi2, double numbers, std::size_t most) {
  if (places.empty()) return {};
  const AtPlace& first = *std::max_element(places.begin(), places.end(),
                                           [](const AtPlace& a, const AtPlace& b) { return a.gain < b.gain; });
  const double scale = std::max(1.0, (chi2 - first.gain) / std::max(1.0, numbers - first.dimension));
  std::vector<double> weights;
  std::vector<std::size_t> order;
  for (const AtPlace& p : places) {
    order.push_back(order.size());
    weights.push_back(std::log(p.prior) + log_evidence(p.gain / scale, p.dimension, false));
  }
  const std::vector<double> probability = normalised(weights);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return probability[a] > probability[b]; });

  const double beyond = std::max(1.0, chi2 - numbers);
  std::vector<Localised> out;
  double sum = 0;
  for (const std::size_t i : order) {
    const AtPlace& p = places[i];
    if (out.size() == most || sum > together_told || p.gain < beyond_chance) break;
    sum += probability[i];
    std::string what = words_of(p.best->effect);
    if (p.other_way) what += ", the other way: the machine yields less there than the model";
    out.push_back({p.best->effect, std::move(what), std::min(1.0, p.gain / beyond), probability[i]});
  }
  return out;
}

}  // namespace deflect::diagnosis
