#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "msa/base/error.h"
#include "msa/base/outcome.h"
#include "msa/base/units.h"
#include "msa/fields/yaml_tree.h"
#include "validation/cli/command.h"
#include "validation/cli/commands/effects.h"
#include "validation/cli/devices.h"
#include "validation/cli/made_by.h"
#include "validation/cli/new_description.h"
#include "validation/cli/talk.h"
#include "validation/diagnosis/found_effects.h"
#include "validation/effects/effect_file.h"
#include "validation/report/effect_results.h"

namespace deflect::cli {
namespace {

struct AddArguments {
  std::string device, effect, leg, from, out, json;
  std::vector<std::string> set, files;
  bool force = false;
};

std::optional<int> parse_leg(const std::string& text) {
  if (text.empty()) return {};
  for (int leg = 1; leg <= 1000; ++leg)
    if (text == std::to_string(leg)) return leg;
  throw InputError(fmt::format("--leg '{}': give the number of a leg, as in --leg 4", text));
}

/// "name=value": numbers in the unit that the name ends with.
std::vector<std::pair<std::string, double>> parse_values(const std::vector<std::string>& set) {
  std::vector<std::pair<std::string, double>> out;
  for (const std::string& text : set) {
    const std::size_t equals = text.find('=');
    if (equals == text.npos) throw InputError(fmt::format("--set '{}': write name=value", text));
    const std::string name = text.substr(0, equals);
    for (const auto& [other, value] : out)
      if (other == name) throw InputError(fmt::format("--set '{}': '{}' is set twice", text, name));
    const auto value = outcome_of<InputError>([&] { return parse_number(std::string_view(text).substr(equals + 1)); });
    if (!value) throw InputError(fmt::format("--set '{}': {}; the name gives the unit", text, value.why));
    out.emplace_back(name, *value);
  }
  return out;
}

/// Values set on the command line take the place of those found.
diagnosis::FoundEffect with_values(diagnosis::FoundEffect found,
                                   const std::vector<std::pair<std::string, double>>& values) {
  for (const auto& given : values) {
    std::erase_if(found.parameters, [&](const auto& p) { return p.first == given.first; });
    found.parameters.push_back(given);
  }
  return found;
}

/// The effect as the diagnosis found it: missing, or only thought of.
diagnosis::FoundEffect look_up(const diagnosis::FoundEffects& all, const std::string& effect, std::optional<int> leg,
                               const std::string& file) {
  std::vector<std::string> names;
  for (const std::vector<diagnosis::FoundEffect>* list : {&all.missing, &all.candidates})
    for (const diagnosis::FoundEffect& f : *list) {
      if (f.effect == effect && (!leg || f.leg == leg)) return f;
      if (std::find(names.begin(), names.end(), f.effect) == names.end()) names.push_back(f.effect);
    }
  throw InputError(fmt::format("{}: the diagnosis has no effect '{}'{}{}", file, effect,
                               leg ? fmt::format(" of leg {}", *leg) : "", suggestion(effect, names)));
}

/// Why there is nothing to add, with the way out.
[[noreturn]] void refuse_nothing_missing(const diagnosis::FoundEffects& found, const std::string& file) {
  const std::string start = file + ": the diagnosis reports no missing effect";
  const char* by_name = "name the effect and give its values with --set";
  if (found.verdict == "nothing_missing")
    throw InputError(fmt::format("{} (verdict nothing_missing): nothing has to be added; to add one all the same, {}",
                                 start, by_name));
  if (found.verdict == "unknown_effect")
    throw InputError(fmt::format("{} that could be added (verdict unknown_effect): {}; mend that, or {}", start,
                                 found.unexplained.empty() ? "what is missing has no name" : found.unexplained,
                                 by_name));
  throw InputError(fmt::format("{}: {}", start, by_name));
}

/// What the diagnosis says against adding all that it found.
void remark_on_verdict(const diagnosis::FoundEffects& found, const std::string& file) {
  if (found.verdict == "unknown_effect")
    remark(
        fmt::format("{}: with what is added something is still missing that the diagnosis cannot name (verdict "
                    "unknown_effect){}{}",
                    file, found.unexplained.empty() ? "" : ": ", found.unexplained));
  if (found.verdict == "ambiguous")
    remark(
        fmt::format("{}: these data support others as much as what is added (verdict ambiguous): 'indistinguishable' "
                    "has them; name one to add it instead",
                    file));
}

/// What the diagnosis says against adding this one.
void remark_if_not_missing(const diagnosis::FoundEffects& found, const std::string& effect, const std::string& file) {
  if (std::none_of(found.missing.begin(), found.missing.end(), [&](const auto& f) { return f.effect == effect; }))
    remark(fmt::format("{} does not report '{}' as missing{}: it is added as it was tried", file, effect,
                       found.verdict.empty() ? "" : fmt::format(" (verdict {})", found.verdict)));
}

std::vector<diagnosis::FoundEffect> wanted(const AddArguments& a) {
  const auto values = parse_values(a.set);
  const std::optional<int> leg = parse_leg(a.leg);
  if (a.from.empty()) {
    if (a.effect.empty()) throw InputError("name the effect to add ('deflect effects' lists them), or give --from");
    return {{a.effect, leg, values}};
  }
  const diagnosis::FoundEffects all = diagnosis::read_found_effects(a.from);
  if (!a.effect.empty()) {
    const diagnosis::FoundEffect found = look_up(all, a.effect, leg, a.from);
    remark_if_not_missing(all, a.effect, a.from);
    return {with_values(found, values)};
  }
  if (all.missing.empty()) refuse_nothing_missing(all, a.from);
  if (leg || !values.empty()) throw InputError("--leg and --set apply to one effect: name it");
  remark_on_verdict(all, a.from);
  return all.missing;
}

std::vector<std::string> names_of(const std::vector<effects::EffectInstance>& added) {
  std::vector<std::string> out;
  for (const effects::EffectInstance& i : added) out.push_back(report::words(i));
  return out;
}

/// One after the other into the device; a diagnosis that they do not fit is named.
std::vector<effects::EffectInstance> add_effects(subject::Subject& m, const AddArguments& a,
                                                 const std::vector<effects::Effect>& all) {
  const std::vector<diagnosis::FoundEffect> effects = wanted(a);
  std::vector<effects::EffectInstance> added;
  told_at<InputError>([&] { return a.from.empty() ? "" : a.from + ": "; },
                      [&] {
                        for (const diagnosis::FoundEffect& found : effects) {
                          added.push_back(diagnosis::instance(effects::find_effect(all, found.effect), found));
                          m = effects::with_effect(m, added.back());
                          tell("effect {} from {}", found.effect, a.from.empty() ? "the command line" : a.from);
                        }
                      });
  return added;
}

void run(const AddArguments& a) {
  subject::Subject m = read_subject(a.device);
  const std::vector<effects::Effect> all = known_effects(a.files, m);
  if (!a.from.empty()) remark_if_of_another(a.from, a.device, m);
  const std::vector<effects::EffectInstance> added = add_effects(m, a, all);
  const std::string old = m.name();
  write_description(m, old, "with", names_of(added), a.out);
  if (!a.json.empty()) write_result(a.json, report::added_json(a.device, a.out, added));
  fmt::print("{}: {} with {}\n", a.out, old, fmt::join(names_of(added), ", "));
}

}  // namespace

Command add_command() {
  auto a = std::make_shared<AddArguments>();
  return {"add",
          "Write a new device file: the device with an added effect. The effect's values come from --set or from a "
          "diagnosis. With --from and without EFFECT, all effects that the diagnosis reports as missing are added",
          "deflect add haptic-6psu guide_root_compliance --set stiffness_Nmm_per_rad=5e6 -o softer.yaml",
          {{"device", "DEVICE", "built-in device or frame, or a file of one", &a->device, true},
           {"effect", "EFFECT", "effect to add; 'deflect effects' lists them", &a->effect},
           {"--set", "NAME=VALUE", "value of a parameter, in the unit at the end of its name", &a->set},
           {"--leg", "NUMBER", "the leg, for an effect of one leg", &a->leg},
           {"--from", "DIAGNOSIS.json", "take effects, legs and values from the result of 'deflect diagnose --json'",
            &a->from},
           {"--effects", "FILE", "your own effect files, in addition to the catalogue", &a->files},
           {"-o,--output", "NEW_DEVICE", "file to write", &a->out, true},
           {"--force", "", "allow the output to overwrite an input", &a->force},
           {"--json", "FILE", "write the added effects", &a->json}},
          [a] { run(*a); }};
}

}  // namespace deflect::cli
