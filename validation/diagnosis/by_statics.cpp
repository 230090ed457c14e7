#include "validation/diagnosis/by_statics.h"

#include <cmath>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/effects/law_of_effect.h"
#include "validation/parallel/cases.h"

namespace deflect {
namespace {

constexpr double agreed = 1e-2;

/// A thousandth of the start, where an effect of one parameter is of the first order in it.
VectorX small_values(const Effect& e) {
  VectorX out = start_values(e);
  const std::optional<double>& vanishes = e.parameters.front().vanishes;
  out *= vanishes && std::isinf(*vanishes) ? 1e3 : 1e-3;
  return out;
}

}  // namespace

ByStatics::ByStatics(const Observations& o, const std::vector<PlacedEffect>& effects, int threads)
    : observations_(o), transmissions_(o.subject().stand(*o.comparison().study.data)->transmissions()) {
  if (!transmissions_) return;
  std::vector<const PlacedEffect*> first;
  for (const PlacedEffect& e : effects)
    if (e.effect->place && law_in_series(*e.effect, start_values(*e.effect)) &&
        known_.emplace(id_of(*e.effect->place), false).second)
      first.push_back(&e);
  std::vector<char> agree(first.size());
  for_each_case(first.size(), 1, threads, [&](std::size_t i) { agree[i] = agrees(*first[i]); });
  for (std::size_t i = 0; i < first.size(); ++i) known_.at(id_of(*first[i]->effect->place)) = agree[i];
}

std::optional<std::vector<Vector6>> ByStatics::by_force(const PlacedEffect& e, const VectorX& values,
                                                        const Measurements& data) const {
  const std::optional<Law> law = law_in_series(*e.effect, values);
  if (!law) return std::nullopt;
  return transmissions_->change(*e.effect->place, e.leg, *law, data);
}

bool ByStatics::agrees(const PlacedEffect& e) const {
  const Measurements some = one_pose(*observations_.comparison().study.data, 0);
  const VectorX small = small_values(*e.effect);
  const auto told = by_force(e, small, some);
  if (!told) return false;
  PredictionOptions linear;
  linear.geometry = Geometry::linear;
  const Standing* drawn = observations_.comparison().study.standing.get();
  const auto off = outcome_of([&] {
    const auto predicted = [&](const Subject& s) { return s.stand(some, drawn)->predict(some, linear, alone); };
    const std::vector<Vector6> before = predicted(observations_.subject()),
                               after = predicted(with_effect(observations_.subject(), {e, small}));
    double square = 0, size = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      square += (after[i] - before[i] - (*told)[i]).squaredNorm();
      size += (*told)[i].squaredNorm();
    }
    return std::sqrt(square) - agreed * std::sqrt(size);
  });
  return off && *off <= 0;
}

std::optional<VectorX> ByStatics::change(const PlacedEffect& e) const {
  if (!transmissions_ || !e.effect->place) return std::nullopt;
  const auto known = known_.find(id_of(*e.effect->place));
  if (known == known_.end() || !known->second) return std::nullopt;
  const ResidualStudy& study = observations_.comparison().study;
  const auto told = by_force(e, start_values(*e.effect), *study.data);
  if (!told) return std::nullopt;
  return VectorX(-observations_.uncertainty().whitened(rows_of(study.values, *told)));
}

}  // namespace deflect
