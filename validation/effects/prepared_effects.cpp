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

// What differs between machines and frames.
DependentMechanism with_one(const DependentMechanism& m, const PlacedEffect& p, const VectorX& values,
                            std::size_t first) {
  return with_effect(m, *p.effect, values, p.leg, first);
}
frame::DependentFrame with_one(const frame::DependentFrame& f, const PlacedEffect& p, const VectorX& values,
                               std::size_t first) {
  return with_effect(f, *p.effect, values, first);
}
DependentMechanism dependent(const Mechanism& m) { return {m}; }
frame::DependentFrame dependent(const frame::FrameDescription& f) { return {f}; }
frame::DependentFrame resolved(frame::DependentFrame f) { return f; }
frame::FrameDescription resolved(frame::FrameDescription f) { return f; }

}  // namespace

PreparedEffects::PreparedEffects(const subject::Subject& subject, std::vector<PlacedEffect> effects)
    : effects_(std::move(effects)) {
  if (subject.frame())
    prepare(frame::DependentFrame{*subject.frame()});
  else
    prepare(DependentMechanism{*subject.machine()});
}

template <class Dependent>
void PreparedEffects::prepare(Dependent with) {
  auto bare = description(with);
  for (const PlacedEffect& p : effects_) {
    VectorX values(std::ssize(p.effect->parameters));
    for (Eigen::Index i = 0; i < values.size(); ++i) values(i) = plain_value(nth(p.effect->parameters, i));
    with = with_one(with, p, values, parameters_.size());
    for (const EffectParameter& each : p.effect->parameters) parameters_.push_back(&each);
  }
  with = resolved(std::move(with));
  affine_ = find_slots(described_numbers(description(with)), with.depends);
  versions_ = Versions<decltype(bare)>{std::move(bare), description(with)};
}

bool PreparedEffects::find_slots(const std::vector<DescribedNumber>& numbers, const Dependences& depends) {
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

template <class Description>
Description PreparedEffects::edited_one_by_one(const Description& bare, const VectorX& values) const {
  auto out = dependent(bare);
  Eigen::Index from = 0;
  for (const PlacedEffect& p : effects_) {
    const auto count = std::ssize(p.effect->parameters);
    out = dependent(description(with_one(out, p, values.segment(from, count), 0)));
    from += count;
  }
  return resolved(description(out));
}

template <class Description>
Description PreparedEffects::at(const Versions<Description>& versions, const VectorX& values) const {
  bool vanishes = false;
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    vanishes = vanishes || parameters_[i]->vanishes == values(as_index(i));
  if (!affine_ || vanishes) return edited_one_by_one(versions.bare, values);
  Description out = versions.with;
  auto slot = slots_.begin();
  for_each_number(out, [&](std::size_t at, double& x) {
    if (slot == slots_.end() || slot->at != at) return;
    x = slot->offset + slot->factor * values(as_index(slot->parameter));
    ++slot;
  });
  return out;
}

std::vector<std::size_t> PreparedEffects::moved_by(std::size_t parameter) const {
  std::vector<std::size_t> out;
  for (const Slot& slot : slots_)
    if (affine_ && slot.parameter == parameter) out.push_back(slot.at);
  return out;
}

subject::Subject PreparedEffects::operator()(const VectorX& values) const {
  return std::visit([&](const auto& versions) { return subject::Subject(at(versions, values)); }, versions_);
}

Mechanism PreparedEffects::machine(const VectorX& values) const {
  return at(std::get<Versions<Mechanism>>(versions_), values);
}

}  // namespace deflect::effects
