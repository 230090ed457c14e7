#include "validation/diagnosis/by_statics.h"

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/effects/law_of_effect.h"
#include "validation/parallel/cases.h"

namespace deflect::diagnosis {
namespace {

constexpr double agreed = 1e-2;

/// A thousandth of the start, where an effect of one parameter is of the first order in it.
VectorX small_values(const effects::Effect& e) {
  VectorX out = effects::start_values(e);
  const std::optional<double>& vanishes = e.parameters.front().vanishes;
  out *= vanishes && std::isinf(*vanishes) ? 1e3 : 1e-3;
  return out;
}

}  // namespace

ByStatics::ByStatics(const Observations& o, const std::vector<effects::PlacedEffect>& effects, int threads)
    : observations_(o), transmissions_(o.subject().stand(*o.comparison().study.data)->transmissions()) {
  if (!transmissions_) return;
  null_ = o.residual(o.subject());
  std::vector<const effects::PlacedEffect*> first;
  for (const effects::PlacedEffect& e : effects)
    if (e.effect->place && effects::law_in_series(*e.effect, effects::start_values(*e.effect)) &&
        known_.emplace(subject::id_of(*e.effect->place), false).second)
      first.push_back(&e);
  std::vector<char> agree(first.size());
  parallel::for_each_case(first.size(), 1, threads, [&](std::size_t i) { agree[i] = agrees(*first[i]); });
  for (std::size_t i = 0; i < first.size(); ++i) known_.at(subject::id_of(*first[i]->effect->place)) = agree[i];
}

std::optional<subject::Transmissions::Change> ByStatics::by_force(const effects::PlacedEffect& e, const VectorX& values,
                                                                  const measurement::Measurements& data) const {
  const std::optional<Law> law = effects::law_in_series(*e.effect, values);
  if (!law) return std::nullopt;
  return transmissions_->change(*e.effect->place, e.leg, *law, data);
}

bool ByStatics::agrees(const effects::PlacedEffect& e) const {
  const compare::ResidualStudy& study = observations_.comparison().study;
  const measurement::Measurements some = measurement::one_pose(*study.data, 0);
  const VectorX small = small_values(*e.effect);
  const auto told = by_force(e, small, some);
  if (!told) return false;
  prediction::PredictionOptions linear;
  linear.geometry = Geometry::linear;
  const subject::Standing* drawn = study.standing.get();
  const std::vector<measurement::MeasuredValue> read = measurement::measured_values(some, drawn->sensor_forms(some));
  const VectorX by_statics = statistics::rows_of(read, told->readings);
  const auto off = outcome_of([&] {
    const auto predicted = [&](const subject::Subject& s) {
      return s.stand(some, drawn)->predict(some, linear, parallel::alone);
    };
    const VectorX before = statistics::rows_of(read, predicted(observations_.subject())),
                  after =
                      statistics::rows_of(read, predicted(effects::with_effect(observations_.subject(), {e, small})));
    return (after - before - by_statics).norm() - agreed * by_statics.norm();
  });
  return off && *off <= 0;
}

std::optional<VectorX> ByStatics::change(const effects::PlacedEffect& e) const {
  if (!transmissions_ || !e.effect->place) return std::nullopt;
  const auto known = known_.find(subject::id_of(*e.effect->place));
  if (known == known_.end() || !known->second) return std::nullopt;
  const compare::ResidualStudy& study = observations_.comparison().study;
  const VectorX start = effects::start_values(*e.effect);
  const auto told = by_force(e, start, *study.data);
  if (!told) return std::nullopt;
  VectorX change = -statistics::rows_of(study.values, told->readings);
  if (std::find(told->floats.begin(), told->floats.end(), true) != told->floats.end()) {
    const auto residual = outcome_of([&] {
      const subject::Subject with = effects::with_effect(observations_.subject(), {e, start});
      return observations_.residual_in_shape(with, told->floats);
    });
    for (std::size_t k = 0; residual && k < study.values.size(); ++k)
      if (told->floats[study.values[k].reading]) change(as_index(k)) = (*residual)(as_index(k)) - null_(as_index(k));
  }
  return VectorX(observations_.uncertainty().whitened(change));
}

}  // namespace deflect::diagnosis
