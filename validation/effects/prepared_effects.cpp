#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/mechanism/device_file.h"
#include "validation/effects/number_walk.h"
#include "validation/effects/with_effect.h"

namespace deflect {
namespace {

bool close(double a, double b) { return std::abs(a - b) <= 1e-13 * std::max(std::abs(a), std::abs(b)); }

/// A value beside the start, inside the bounds.
double beside(const EffectParameter& p, double part) {
  const double to = p.high - p.start > p.start - p.low ? p.high : p.low;
  if (p.log) return p.start * std::pow(to / p.start, part);
  return p.start + part * (to - p.start);
}

}  // namespace

PreparedEffects::PreparedEffects(const Mechanism& m, std::vector<PlacedEffect> effects)
    : bare_(m), effects_(std::move(effects)) {
  for (const PlacedEffect& p : effects_)
    for (const EffectParameter& each : p.effect->parameters) parameters_.push_back(&each);
  with_ = edited_one_by_one(probe(0));  // throws where an effect has no place
  try {
    affine_ = find_slots() && slots_hold();
  } catch (const InputError&) {  // the description cannot hold all values that were tried
    affine_ = false;
  }
}

VectorX PreparedEffects::probe(double part) const {
  VectorX out(parameter_count());
  for (Eigen::Index i = 0; i < out.size(); ++i) out(i) = beside(*parameters_[static_cast<std::size_t>(i)], part);
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
      Slot slot{k, static_cast<std::size_t>(i), 0, at_base[k] / base(i)};
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
  const std::vector<double> quick = numbers_of((*this)(x)), slow = numbers_of(edited_one_by_one(x));
  return std::equal(quick.begin(), quick.end(), slow.begin(), slow.end(), close);
}

Mechanism PreparedEffects::edited_one_by_one(const VectorX& values) const {
  Mechanism out = bare_;
  Eigen::Index from = 0;
  for (const PlacedEffect& p : effects_) {
    const auto count = static_cast<Eigen::Index>(p.effect->parameters.size());
    out = with_effect(out, *p.effect, values.segment(from, count), p.leg);
    from += count;
  }
  return resolved(out);
}

Mechanism PreparedEffects::operator()(const VectorX& values) const {
  bool vanishes = false;
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    vanishes = vanishes || parameters_[i]->vanishes == values(static_cast<Eigen::Index>(i));
  if (!affine_ || vanishes) return edited_one_by_one(values);
  Mechanism out = with_;
  auto slot = slots_.begin();
  for_each_number(out, [&](std::size_t at, double& x) {
    if (slot == slots_.end() || slot->at != at) return;
    x = slot->offset + slot->factor * values(static_cast<Eigen::Index>(slot->parameter));
    ++slot;
  });
  return out;
}

}  // namespace deflect
