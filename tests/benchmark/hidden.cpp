#include "tests/benchmark/hidden.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <set>

#include "msa/base/error.h"
#include "msa/base/outcome.h"
#include "validation/statistics/columns.h"

namespace deflect::benchmark {
namespace {

using namespace diagnosis;
using namespace effects;
using namespace measurement;

constexpr double accuracy = 0.02;  // of λ

/// ±1 for each parameter whose sign is free; of several of them a direction of length √n.
VectorX drawn_signs(const effects::Effect& e, measurement::Random& random) {
  VectorX out = VectorX::Ones(static_cast<Eigen::Index>(e.parameters.size()));
  Eigen::Index free = 0;
  for (std::size_t i = 0; i < e.parameters.size(); ++i) {
    const effects::EffectParameter& p = e.parameters[i];
    if (!p.vanishes || !(p.low < *p.vanishes && *p.vanishes < p.high)) continue;
    out(static_cast<Eigen::Index>(i)) = random.normal();
    ++free;
  }
  if (free == out.size() && free > 0) out *= std::sqrt(static_cast<double>(free)) / out.norm();
  return out;
}

/// The values at which the effect is `times` as large as at its start; nothing outside the bounds.
std::optional<VectorX> values_at(const effects::Effect& e, const VectorX& signs, double times) {
  VectorX out = start_values(e);
  for (std::size_t i = 0; i < e.parameters.size(); ++i) {
    const effects::EffectParameter& p = e.parameters[i];
    double& value = out(static_cast<Eigen::Index>(i));
    const double by = times * signs(static_cast<Eigen::Index>(i));
    if (p.vanishes) value = std::isinf(*p.vanishes) ? p.start / by : *p.vanishes + by * (p.start - *p.vanishes);
    if (!(p.low <= value && value <= p.high)) return std::nullopt;
  }
  return out;
}

}  // namespace

std::optional<Hidden> hidden_effect(const Plan& plan, const effects::Effect& e, double lambda,
                                    measurement::Random& random) {
  const std::vector<effects::PlacedEffect> places = places_of(e, plan.observations->subject());
  if (places.empty()) return std::nullopt;
  const double lot = random.uniform(0, static_cast<double>(places.size()));
  return hidden_effect(plan, places[static_cast<std::size_t>(lot)], drawn_signs(e, random), lambda);
}

std::vector<VectorX> possible_signs(const effects::Effect& e, std::size_t directions, measurement::Random& random) {
  const VectorX ones = VectorX::Ones(static_cast<Eigen::Index>(e.parameters.size()));
  std::vector<VectorX> out = {ones};
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < e.parameters.size(); ++i) {
    const effects::EffectParameter& p = e.parameters[i];
    if (p.vanishes && p.low < *p.vanishes && *p.vanishes < p.high) free.push_back(static_cast<Eigen::Index>(i));
  }
  if (free.size() == 1) {
    out.push_back(ones);
    out.back()(free.front()) = -1;
  } else if (free.size() > 1) {
    out.clear();
    for (std::size_t i = 0; i < directions; ++i) out.push_back(drawn_signs(e, random));
  }
  return out;
}

std::optional<Hidden> hidden_effect(const Plan& plan, const effects::PlacedEffect& placed, const VectorX& signs,
                                    double lambda) {
  const effects::Effect& e = *placed.effect;
  Hidden out;
  static_cast<effects::PlacedEffect&>(out.effect) = placed;
  const auto at = [&](double x) {  // ln λ over ln of the size; nothing outside the bounds
    std::optional<double> y;
    if (const std::optional<VectorX> values = values_at(e, signs, std::exp(x))) try {
        out.effect.values = *values;
        out.change = plan.whitened_change(out.effect);
        if (out.lambda() > 0) y = std::log(out.lambda());
      } catch (const ModelError&) {
      } catch (const NumericalError&) {
      } catch (const InputError&) {  // wants a sequence or a temperature
      }
    return y;
  };
  double x = 0, slope = 1;
  std::optional<double> y = at(x);
  for (int tries = 0; y && tries < 20; ++tries) {
    const double step = (std::log(lambda) - *y) / slope;
    if (std::abs(out.lambda() / lambda - 1) < accuracy) return out;
    double next = x + std::clamp(step, -4.0, 4.0);
    std::optional<double> there = at(next);
    for (int back = 0; !there && back < 8; ++back) there = at(next = (next + x) / 2);
    if (!there) return std::nullopt;
    slope = std::clamp((*there - *y) / (next - x), 0.2, 5.0);
    x = next;
    y = there;
  }
  return std::nullopt;
}

Nearest nearest_entry(const Plan& plan, const Hidden& hidden) {
  int amplitudes = 1;
  for (const Signature& s : plan.signatures)
    if (s.effect.effect == hidden.effect.effect) amplitudes = s.amplitudes();
  Nearest out;
  for (const Signature& s : plan.signatures) {
    if (s.effect.effect == hidden.effect.effect || s.amplitudes() > amplitudes) continue;
    const VectorX along = s.basis.transpose() * hidden.change;
    const double c = (s.shaped ? along.cwiseAbs().maxCoeff() : along.norm()) / hidden.lambda();
    if (c > out.cosine) out.cosine = c, out.entry = s.effect.effect->name;
  }
  out.separation = std::pow(hidden.lambda(), 2) * std::max(0.0, 1 - out.cosine * out.cosine);
  return out;
}

double cosine(const Hidden& a, const Hidden& b) { return std::abs(a.change.dot(b.change)) / (a.lambda() * b.lambda()); }

VectorX beyond_catalogue(const Plan& plan, const VectorX& change, const effects::Effect* left_out) {
  Eigen::Index columns = 0;
  MatrixX all(change.size(), 0);
  for (const Signature& s : plan.signatures) {
    if (s.effect.effect == left_out) continue;
    all.conservativeResize(Eigen::NoChange, columns + s.basis.cols());
    all.rightCols(s.basis.cols()) = s.basis;
    columns = all.cols();
  }
  Eigen::ColPivHouseholderQR<MatrixX> qr;
  qr.setThreshold(1e-6);
  qr.compute(all);
  VectorX along = qr.householderQ().transpose() * change;
  along.head(qr.rank()).setZero();
  return qr.householderQ() * along;
}

namespace {

/// The same with two laws at one place, which together may be a third one: a spring is what yields to pull and what
/// yields to push as much.
double beyond_two_at_a_place(const Plan::Told& told, const std::vector<std::string>& left_out) {
  const VectorX& change = told.change;
  std::vector<const Signature*> single;
  for (const Signature& s : told.signatures)
    if (s.effect.effect->place && !s.shaped && s.basis.cols() == 1 &&
        std::find(left_out.begin(), left_out.end(), s.effect.effect->name) == left_out.end())
      single.push_back(&s);
  const auto at = [](const Signature& s) { return std::pair(subject::id_of(*s.effect.effect->place), s.effect.leg); };
  double least = change.norm();
  for (std::size_t i = 0; i < single.size(); ++i)
    for (std::size_t k = i + 1; k < single.size(); ++k) {
      if (at(*single[i]) != at(*single[k])) continue;
      const MatrixX both =
          statistics::orthonormal(statistics::side_by_side({single[i]->basis, single[k]->basis}, change.size()), 1e-6);
      least = std::min(least, (change - both * (both.transpose() * change)).norm());
    }
  return least;
}

/// "yields" of "yields@elbow.rz".
std::string law_of(const effects::Effect& e) { return e.name.substr(0, e.name.find('@')); }

using Parts = std::set<std::pair<std::string, std::vector<std::size_t>>>;
Parts parts_of(const subject::Place& p) {
  Parts out = {{p.path, p.freedoms}};
  for (const subject::OtherPart& o : p.others) out.emplace(o.path, o.freedoms);
  return out;
}

/// The same with the law of a group, which is that law at all of its parts together, one by one or in smaller groups:
/// nothing is left where these are candidates.
double beyond_its_parts(const Plan::Told& told, const effects::Effect& e, const std::vector<std::string>& left_out) {
  if (!e.place || e.place->others.empty()) return told.change.norm();
  Parts all = parts_of(*e.place), found;
  for (const Signature& s : told.signatures) {
    const effects::Effect& other = *s.effect.effect;
    if (!other.place || law_of(other) != law_of(e) ||
        std::find(left_out.begin(), left_out.end(), other.name) != left_out.end())
      continue;
    const Parts own = parts_of(*other.place);
    if (std::includes(all.begin(), all.end(), own.begin(), own.end())) found.insert(own.begin(), own.end());
  }
  return found == all ? 0 : told.change.norm();
}

/// The same with the factor of one load, which is that of all loads less those of the others.
double beyond_other_loads(const Plan::Told& told, const effects::Effect& e, const std::vector<std::string>& left_out) {
  double least = told.change.norm();
  if (!e.place || e.place->kind != subject::PlaceKind::load) return least;
  std::vector<MatrixX> others;
  for (const Signature& s : told.signatures)
    if (s.effect.effect->place && s.effect.effect->place->kind == e.place->kind &&
        law_of(*s.effect.effect) == law_of(e) &&
        std::find(left_out.begin(), left_out.end(), s.effect.effect->name) == left_out.end())
      others.push_back(s.basis);
  for (const Signature& s : told.signatures) {
    if (s.shaped || s.effect.effect->place) continue;
    std::vector<MatrixX> with = others;
    with.push_back(s.basis);
    const MatrixX all = statistics::orthonormal(statistics::side_by_side(with, told.change.size()), 1e-6);
    least = std::min(least, (told.change - all * (all.transpose() * told.change)).norm());
  }
  return least;
}

/// The same with the law of the hidden effect at another place, with the same values, where it may do the same:
/// friction in two joints that always turn alike, play of two that turn one link. A signature is of other values; the
/// two places whose signatures come nearest are predicted.
double beyond_law_elsewhere(const Plan& plan, const Plan::Told& told, const effects::EffectInstance& hidden,
                            const std::vector<std::string>& left_out) {
  constexpr std::size_t predicted = 2;
  std::vector<std::pair<double, const Signature*>> others;
  for (const Signature& s : told.signatures) {
    const effects::Effect& other = *s.effect.effect;
    if (&other != hidden.effect && other.place && law_of(other) == law_of(*hidden.effect) &&
        other.parameters.size() == hidden.effect->parameters.size() &&
        std::find(left_out.begin(), left_out.end(), other.name) == left_out.end())
      others.emplace_back((s.basis.transpose() * told.change).cwiseAbs().maxCoeff(), &s);
  }
  std::stable_sort(others.begin(), others.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  others.resize(std::min(predicted, others.size()));
  double least = told.change.norm();
  for (const auto& [along, other] : others) {
    const auto told_there = outcome_of([&] { return plan.told({other->effect, hidden.values}).change; });
    if (!told_there) continue;  // what may be of this size here may not be there
    const VectorX& there = *told_there;
    if (there.size() != told.change.size() || there.isZero(0)) continue;
    least = std::min(least, (told.change - there * (there.dot(told.change) / there.squaredNorm())).norm());
  }
  return least;
}

}  // namespace

double beyond_others(const Plan& plan, const Hidden& hidden, const std::vector<std::string>& left_out) {
  const Plan::Told told = plan.told(hidden.effect);
  const VectorX& change = told.change;
  const effects::Effect& e = *hidden.effect.effect;
  constexpr int most = 4;
  constexpr double least_own = 1e-6;  // of a unit column: less is rounding
  VectorX left = change;
  MatrixX taken(change.size(), 0);
  for (int round = 0; round < most; ++round) {
    double gain = 0;
    MatrixX best;
    for (const Signature& s : told.signatures) {
      if (std::find(left_out.begin(), left_out.end(), s.effect.effect->name) != left_out.end()) continue;
      const MatrixX beside = s.basis - taken * (taken.transpose() * s.basis);
      if (s.shaped || s.basis.cols() == 1) {  // one column at a time
        for (const auto column : beside.colwise()) {
          const double length = column.norm(), along = column.dot(left);
          if (length > least_own && along * along > gain * length * length)
            gain = along * along / (length * length), best = column / length;
        }
        continue;
      }
      const MatrixX own = statistics::orthonormal(beside, least_own);
      if (const double g = (own.transpose() * left).squaredNorm(); g > gain) gain = g, best = own;
    }
    if (best.cols() == 0) break;
    taken = statistics::side_by_side({taken, best}, change.size());
    left = change - taken * (taken.transpose() * change);
  }
  return std::min({left.norm(), beyond_two_at_a_place(told, left_out), beyond_its_parts(told, e, left_out),
                   beyond_other_loads(told, e, left_out), beyond_law_elsewhere(plan, told, hidden.effect, left_out)});
}

}  // namespace deflect::benchmark
