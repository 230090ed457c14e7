#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/numbers.h"
#include "validation/effects/with_effect.h"

namespace deflect::effects {
namespace {

/// A value that is not zero, at which no edit vanishes: the start, or one beside it.
double plain_value(const EffectParameter& p) {
  if (p.start != 0 && p.vanishes != p.start) return p.start;
  const double to = p.high - p.start > p.start - p.low ? p.high : p.low;
  return p.start + 0.11 * (to - p.start);
}

}  // namespace

PreparedEffects::PreparedEffects(const subject::Subject& subject, std::vector<PlacedEffect> effects)
    : effects_(std::move(effects)) {
  if (!subject.machine()) throw InputError(subject.name() + ": effects act on parts of machines, this is a frame");
  bare_ = *subject.machine();
  DependentMechanism with{bare_};
  for (const PlacedEffect& p : effects_) {
    VectorX values(std::ssize(p.effect->parameters));
    for (Eigen::Index i = 0; i < values.size(); ++i) values(i) = plain_value(nth(p.effect->parameters, i));
    with = with_effect(with, *p.effect, values, p.leg, parameters_.size());
    for (const EffectParameter& each : p.effect->parameters) parameters_.push_back(&each);
  }
  with = resolved(with);
  with_ = std::move(with.mechanism);
  affine_ = find_slots(with.depends);
}

bool PreparedEffects::find_slots(const Dependences& depends) {
  const std::vector<DescribedNumber> numbers = described_numbers(with_);
  std::vector<bool> used(parameters_.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto found = depends.find(numbers[i].path);
    if (found == depends.end()) continue;
    const Dependence& on = found->second;
    if (!on.alone) return false;
    slots_.push_back({i, on.parameter, on.offset, on.factor});
    used[on.parameter] = true;
  }
  return std::all_of(used.begin(), used.end(), [](bool each) { return each; });
}

Mechanism PreparedEffects::edited_one_by_one(const VectorX& values) const {
  Mechanism out = bare_;
  Eigen::Index from = 0;
  for (const PlacedEffect& p : effects_) {
    const auto count = std::ssize(p.effect->parameters);
    out = with_effect(out, *p.effect, values.segment(from, count), p.leg);
    from += count;
  }
  return resolved(out);
}

subject::Subject PreparedEffects::operator()(const VectorX& values) const { return machine(values); }

Mechanism PreparedEffects::machine(const VectorX& values) const {
  bool vanishes = false;
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    vanishes = vanishes || parameters_[i]->vanishes == values(as_index(i));
  if (!affine_ || vanishes) return edited_one_by_one(values);
  Mechanism out = with_;
  auto slot = slots_.begin();
  for_each_number(out, [&](std::size_t at, double& x) {
    if (slot == slots_.end() || slot->at != at) return;
    x = slot->offset + slot->factor * values(as_index(slot->parameter));
    ++slot;
  });
  return out;
}

}  // namespace deflect::effects
