// What an answer is worth beside the truth.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace deflect::benchmark {

/// What was hidden: names of effects; nothing; or something that no effect of the catalogue describes.
struct Truth {
  std::vector<std::string> effects;
  bool unknown = false;
  std::string tied;  ///< the entry that does the same to these data; empty where there is none
};

/// What a method says. `groups`: effects that it cannot tell apart.
struct Answer {
  std::string verdict = "nothing_missing";
  std::vector<std::string> missing;
  std::vector<std::vector<std::string>> groups;
  std::string first;  ///< its first candidate, with the probability it gives to it
  double probability = 0;
};

template <class Archive>
void serialize(Archive& a, Answer& x) {
  a(x.verdict, x.missing, x.groups, x.first, x.probability);
}

enum class Outcome { right, partly, missed, wrong };  // wrong: with confidence
inline constexpr const char* outcome_names[] = {"right", "partly", "missed", "wrong"};

inline bool holds(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// The effects that an answer leaves in question: those named and those that tie with them, once each.
inline std::vector<std::string> reported(const Answer& a) {
  std::vector<std::string> out = a.missing;
  for (const std::vector<std::string>& group : a.groups) out.insert(out.end(), group.begin(), group.end());
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

inline Outcome judge(const Truth& truth, const Answer& a) {
  constexpr double sure = 0.9;
  const Outcome otherwise = a.verdict == "effect" && a.probability >= sure ? Outcome::wrong : Outcome::missed;
  if (truth.unknown) return a.verdict == "unknown_effect" ? Outcome::right : otherwise;
  if (truth.effects.empty()) return a.verdict == "nothing_missing" ? Outcome::right : otherwise;
  const auto among = [&](const std::vector<std::string>& list) {
    return std::any_of(truth.effects.begin(), truth.effects.end(),
                       [&](const std::string& name) { return holds(list, name); });
  };
  if (!truth.tied.empty()) {
    for (const std::vector<std::string>& group : a.groups)
      if (among(group) && holds(group, truth.tied)) return Outcome::right;
    return among(a.missing) ? Outcome::partly : Outcome::missed;
  }
  std::vector<std::string> want = truth.effects, got = a.missing;
  std::sort(want.begin(), want.end());
  std::sort(got.begin(), got.end());
  if (want == got && (a.verdict == "effect" || a.verdict == "ambiguous")) return Outcome::right;
  if (a.verdict == "ambiguous" && among(reported(a))) return Outcome::partly;
  if (a.verdict == "nothing_missing") return Outcome::missed;
  return among(a.missing) ? Outcome::partly : otherwise;
}

}  // namespace deflect::benchmark
