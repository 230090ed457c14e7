#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/mechanism/device_file.h"
#include "validation/effects/number_walk.h"
#include "validation/effects/with_effect.h"

namespace deflect::effects {
namespace {

bool close(double a, double b) { return std::abs(a - b) <= 1e-13 * std::max(std::abs(a), std::abs(b)); }

/// A value beside the start, inside the bounds.
double beside(const EffectParameter& p, double part) {
  const double to = p.high - p.start > p.start - p.low ? p.high : p.low;
  if (p.log) return p.start * std::pow(to / p.start, part);
  return p.start + part * (to - p.start);
}

}  // namespace

PreparedEffects::PreparedEffects(const subject::Subject& subject, std::vector<PlacedEffect> effects)
    : effects_(std::move(effects)) {
  if (!subject.machine()) throw InputError(subject.name() + ": effects act on parts of machines, this is a frame");
  bare_ = *subject.machine();
  for (const PlacedEffect& p : effects_)
    for (const EffectParameter& each : p.effect->parameters) parameters_.push_back(&each);
  with_ = edited_one_by_one(probe(0));  // throws where an effect has no place
  const auto seen = outcome_of<InputError>([&] { return find_slots() && slots_hold(); });
  affine_ = seen && *seen;  // the description may not hold all values that were tried
}

VectorX PreparedEffects::probe(double part) const {
  VectorX out(parameter_count());
  for (Eigen::Index i = 0; i < out.size(); ++i) out(i) = beside(*nth(parameters_, i), part);
  return out;
}

bool PreparedEffects::find_slots() {
  const VectorX base = probe(0.11);
  with_ = edited_one_by_one(base);
  const std::vector<double> at_base = numbers_of(with_);
  for (Eigen::Index i = 0; i < base.size(); ++i) {
    VectorX moved = base;
    moved(i) = probe(0.37)(i);
    const std::vector<double> there = numbers_of(edited_one_by_one(moved));
    if (there.size() != at_base.size()) return false;
    for (std::size_t k = 0; k < at_base.size(); ++k) {
      if (there[k] == at_base[k]) continue;
      Slot slot{k, as_size(i), 0, at_base[k] / base(i)};
      if (!close(slot.factor * moved(i), there[k])) {
        slot.factor = (there[k] - at_base[k]) / (moved(i) - base(i));
        slot.offset = at_base[k] - slot.factor * base(i);
      }
      slots_.push_back(slot);
    }
  }
  std::sort(slots_.begin(), slots_.end(), [](const Slot& a, const Slot& b) { return a.at < b.at; });
  const auto twice = [](const Slot& a, const Slot& b) { return a.at == b.at; };
  return std::adjacent_find(slots_.begin(), slots_.end(), twice) == slots_.end();
}

bool PreparedEffects::slots_hold() const {
  const VectorX x = probe(0.71);
  const std::vector<double> quick = numbers_of(machine(x)), slow = numbers_of(edited_one_by_one(x));
  return std::equal(quick.begin(), quick.end(), slow.begin(), slow.end(), close);
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
