#include "validation/effects/scanned_effects.h"

#include <fmt/format.h>

#include <limits>

#include "msa/mechanism/device_file.h"

namespace deflect {
namespace {

/// A law as it is written into the description, with a small size.
struct ScannedLaw {
  std::string words, name, unit;
  double start;
  bool stiffness;  // vanishes where it is infinite
  std::string value;
};

std::vector<ScannedLaw> laws(bool rotation) {
  const std::string angle = rotation ? "rad" : "mm", force = rotation ? "Nmm" : "N";
  const double small = rotation ? 1e-2 : 1;  // rad a mm, at a hundredth of a metre
  const std::string stiffness = "stiffness_" + force + "_per_" + angle, gap = "gap_" + angle,
                    yields = "yields_" + angle + "_per_" + force;
  std::vector<ScannedLaw> out = {{"like a spring", stiffness, force + "/" + angle, rotation ? 1e9 : 1e5, true,
                                  "{law: linear, stiffness: $" + stiffness + "}"},
                                 {"with play", gap, angle, 1e-4 * small, false, "{law: clearance, gap: $" + gap + "}"},
                                 {"when pulled only", yields, angle + "/" + force, 1e-6 * small * small, false,
                                  "{law: one_sided, pull: $" + yields + "}"},
                                 {"when pushed only", yields, angle + "/" + force, 1e-6 * small * small, false,
                                  "{law: one_sided, push: $" + yields + "}"}};
  if (!rotation)
    out.push_back({"like a contact", "approach_mm", "mm", 1e-5, false,
                   "{law: power, deflection: $approach_mm, force: 1 N, exponent: 0.66666666666666663}"});
  return out;
}

Effect effect_at(const std::string& path, const std::string& words, const ScannedLaw& law, Scope scope) {
  Effect e;
  e.name = e.title = fmt::format("{}, {}", words, law.words);
  e.scope = scope;
  EffectParameter p;
  p.name = law.name;
  p.unit = law.unit;
  p.start = law.start;
  p.low = law.start * 1e-6;
  p.high = law.start * 1e6;
  p.log = true;
  p.vanishes = law.stiffness ? std::numeric_limits<double>::infinity() : 0;
  e.parameters = {p};
  e.edits = {{EffectEdit::Action::append, {path}, law.value}};
  e.origin = "scan";
  return e;
}

}  // namespace

std::vector<Effect> scanned_effects(const Subject& subject) {
  if (!subject.machine()) return {};
  static const char* directions[] = {"tx", "ty", "tz", "rx", "ry", "rz"};
  std::vector<Effect> out;
  const Mechanism whole = resolved(*subject.machine());
  const bool several = whole.legs.size() > 1;
  const auto add = [&](const std::string& site, const std::string& words, Scope scope) {
    for (std::size_t d = 0; d < 6; ++d)
      for (const ScannedLaw& law : laws(d >= 3)) {
        if (scope == Scope::one_leg && !law.stiffness) continue;
        out.push_back(effect_at(
            site + "." + directions[d],
            fmt::format("{} {}{}", words, directions[d], scope == Scope::all_legs && several ? " of every leg" : ""),
            law, scope));
      }
  };
  for (const auto& [name, part] : whole.legs.front())
    if (std::holds_alternative<Joint>(part)) {
      add("leg." + name, name, Scope::all_legs);
      if (several) add("leg." + name, name, Scope::one_leg);
    }
  add("base", "the base's", Scope::machine);
  add("tool", "the tool's", Scope::machine);
  return out;
}

}  // namespace deflect
