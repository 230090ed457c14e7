// What an answer is worth beside the truth where effects that the data cannot tell apart are one class.
//
// An effect that is reported stands for a hidden one where it is in the hidden one's class, or ties with one that is.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/benchmark/judge.h"

namespace deflect::benchmark {

/// Names of effects that the data cannot tell from the hidden one, its own among them.
using EffectClass = std::vector<std::string>;

inline bool meet(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  return std::any_of(a.begin(), a.end(), [&](const std::string& name) { return holds(b, name); });
}

inline bool stands_for(const Answer& a, const std::string& reported, const EffectClass& hidden) {
  return holds(hidden, reported) || std::any_of(a.groups.begin(), a.groups.end(), [&](const auto& group) {
           return holds(group, reported) && meet(group, hidden);
         });
}

inline bool names_effects(const Answer& a) { return a.verdict == "effect" || a.verdict == "ambiguous"; }

/// Each hidden effect is stood for by an effect of its own, and nothing else is reported. With nothing hidden: nothing
/// is missing.
inline bool exactly(const Answer& a, const std::vector<EffectClass>& hidden) {
  if (hidden.empty()) return a.verdict == "nothing_missing";
  if (!names_effects(a) || a.missing.size() != hidden.size()) return false;
  std::vector<std::size_t> order(hidden.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  do {
    bool all = true;
    for (std::size_t i = 0; i < order.size(); ++i) all = all && stands_for(a, a.missing[i], hidden[order[i]]);
    if (all) return true;
  } while (std::next_permutation(order.begin(), order.end()));
  return false;
}

/// How many of the effects reported stand for nothing that is hidden.
inline std::size_t false_reports(const Answer& a, const std::vector<EffectClass>& hidden) {
  return static_cast<std::size_t>(std::count_if(a.missing.begin(), a.missing.end(), [&](const std::string& name) {
    return std::none_of(hidden.begin(), hidden.end(), [&](const EffectClass& c) { return stands_for(a, name, c); });
  }));
}

/// One name without a doubt, and nothing that is reported is true.
inline bool confident_and_wrong(const Answer& a, const std::vector<EffectClass>& hidden) {
  constexpr double sure = 0.9;
  return a.verdict == "effect" && a.probability >= sure && false_reports(a, hidden) == a.missing.size();
}

/// Every hidden effect, or one of its class, is among those reported.
inline bool all_reported(const Answer& a, const std::vector<EffectClass>& hidden) {
  const std::vector<std::string> names = reported(a);
  return std::all_of(hidden.begin(), hidden.end(), [&](const EffectClass& c) { return meet(names, c); });
}

}  // namespace deflect::benchmark
