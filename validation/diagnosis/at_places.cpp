#include "validation/diagnosis/at_places.h"

#include <algorithm>
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

AtPlace explained_by(const LawsAtPlace& place, const VectorX& residual, const MatrixX& fitted) {
  AtPlace out;
  out.prior = place.prior;
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
  if (const auto& whatever = place.laws.front()->whatever_the_law) add(*whatever);
  out.other_way = out.best->one_sided && out.best->start_along(residual) > 0;
  if (columns.empty()) return out;
  const MatrixX span = statistics::orthonormal(statistics::side_by_side(columns, residual.size()), left_of_a_column);
  out.dimension = static_cast<int>(span.cols());
  out.gain = (span.transpose() * residual).squaredNorm();
  return out;
}

}  // namespace

std::vector<AtPlace> at_places(const std::vector<Signature>& all, const Fit& fit, int threads) {
  const MatrixX fitted =
      fit.signature.cols() > 0 ? statistics::orthonormal(fit.signature) : MatrixX(fit.residual.size(), 0);
  const std::vector<LawsAtPlace> places = laws_by_place(all);
  std::vector<AtPlace> out(places.size());
  parallel::for_each_case(places.size(), 1, threads,
                          [&](std::size_t i) { out[i] = explained_by(places[i], fit.residual, fitted); });
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

}  // namespace deflect::diagnosis
