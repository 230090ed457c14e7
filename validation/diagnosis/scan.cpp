#include "validation/diagnosis/scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "msa/mechanism/device_file.h"
#include "validation/diagnosis/signatures.h"
#include "validation/statistics/columns.h"

namespace deflect {
namespace {

constexpr double alike_place = 0.995;  // cosine from which one place stands for another
constexpr double beyond_chance = 30;   // in χ², of a few hundred that are looked at

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

std::vector<Effect> hypotheses(const Mechanism& m) {
  static const char* directions[] = {"tx", "ty", "tz", "rx", "ry", "rz"};
  std::vector<Effect> out;
  const Mechanism whole = resolved(m);
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

}  // namespace

std::vector<Localised> scan(const Observations& o, const Fit& fit, int threads, std::size_t most) {
  const std::vector<Effect> all = hypotheses(o.device());
  const std::vector<Signature> found = signatures(o, all, threads);
  const MatrixX fitted = orthonormal(fit.signature);
  std::vector<double> gain;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Signature& s = found[i];
    gain.push_back(most_gain(s, fit.residual, fitted));
    order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return gain[a] > gain[b]; });
  const double beyond = std::max(1.0, fit.chi2 - static_cast<double>(o.numbers()));
  std::vector<Localised> out;
  std::vector<std::size_t> taken;
  for (const std::size_t i : order) {
    if (out.size() == most || gain[i] < beyond_chance) break;
    if (std::any_of(taken.begin(), taken.end(),
                    [&](std::size_t k) { return cosine(found[i], found[k]) > alike_place; }))
      continue;
    taken.push_back(i);
    const PlacedEffect& e = found[i].effect;
    std::string what = e.leg ? fmt::format("{} of {}", e.effect->name, site_of(e)) : e.effect->name;
    if (found[i].at_start.dot(fit.residual) > 0)
      what += ", the other way: the machine yields less there than the model";
    out.push_back({std::move(what), std::min(1.0, gain[i] / beyond)});
  }
  return out;
}

}  // namespace deflect
