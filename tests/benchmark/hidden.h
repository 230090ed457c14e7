// Effects to be hidden, made as large as is wanted.
#pragma once

#include <optional>

#include "tests/benchmark/plan.h"
#include "validation/measurement/random.h"

namespace deflect::benchmark {

/// λ: length of what the effect changes in the plan's numbers, whitened with noise and tolerances.
struct Hidden {
  effects::EffectInstance effect;
  VectorX change;  ///< whitened

  double lambda() const { return change.norm(); }
};

/// The effect with that λ (to 2 %) at a leg and with signs drawn by lot where they are free; parameters that only shape
/// it stay at their start. Nothing where the bounds of its parameters do not let it become so large.
std::optional<Hidden> hidden_effect(const Plan&, const effects::Effect&, double lambda, measurement::Random&);

/// The same at a given place; `signs`: of each parameter, ±1 or the components of a direction.
std::optional<Hidden> hidden_effect(const Plan&, const effects::PlacedEffect&, const VectorX& signs, double lambda);

/// Signs by which the effect may be drawn: all of them, or of several free ones so many directions drawn by lot.
std::vector<VectorX> possible_signs(const effects::Effect&, std::size_t directions, measurement::Random&);

/// The entry of another name, of no more directions, that comes nearest to the change. Separation: what the best of it
/// leaves of λ², the difference of 2 ln L to be expected. A tie has a cosine above 0.995: data of this plan cannot tell
/// the two apart.
struct Nearest {
  std::string entry;  ///< empty where no entry is at all alike
  double cosine = 0, separation = 0;
  bool tie() const { return cosine > 0.995; }
};
Nearest nearest_entry(const Plan&, const Hidden&);

/// |cosine| of two changes.
double cosine(const Hidden&, const Hidden&);

/// Length of what is left of what an effect changes, whitened, once other effects, none of those named, are taken out
/// of it: the least of five ways. The four that take most of it off, one after the other; the two at one place that
/// do; of the law of a group, the same law at each of its parts; of the law of a load, the same law at all other loads
/// and an entry of the catalogue; the same law at another place, with the same values. Readings that tell
/// no law from another (Plan::told()) do not count.
double beyond_others(const Plan&, const Hidden&, const std::vector<std::string>& left_out);

/// What is left of a whitened change once the signatures of all effects, one left out, are taken out of it.
VectorX beyond_catalogue(const Plan&, const VectorX& change, const effects::Effect* left_out = nullptr);

}  // namespace deflect::benchmark
