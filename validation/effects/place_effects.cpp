#include "validation/effects/place_effects.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <regex>
#include <set>

#include "msa/base/outcome.h"
#include "validation/effects/edit_paths.h"
#include "validation/effects/place_laws.h"

namespace deflect::effects {
namespace {

/// What stands for "{}" in a page.
std::string with_place(const std::string& page, const std::string& place) {
  std::string out = page;
  for (std::size_t at = out.find("{}"); at != out.npos; at = out.find("{}"))
    out.replace(at, 2, at == 0 ? "The " + place : "the " + place);
  return out;
}

std::vector<EffectEdit> edits_of(const PlaceLaw& law, const subject::Place& p,
                                 const std::vector<EffectParameter>& parameters) {
  const std::string value = law.value(parameters, p);
  std::vector<EffectEdit> out;
  const auto add = [&](const std::string& path, const std::vector<std::size_t>& freedoms) {
    const std::string head = law.side_by_side && p.hold == subject::Hold::elastic ? path + ".beside" : path;
    for (const std::size_t i : freedoms) {
      const std::string freedom = subject::freedom_name(p, i);
      out.push_back({law.action,
                     {law.field == std::string(".settled") ? fmt::format("{}.settled.{}", head, freedom)
                                                           : fmt::format("{}.{}{}", head, freedom, law.field)},
                     value});
    }
    if (freedoms.empty()) out.push_back({law.action, {head + law.field}, value});
  };
  if (law.axes) {
    const std::vector<std::size_t>& axes = p.*law.axes;
    for (std::size_t k = 0; k < axes.size(); ++k)
      out.push_back({law.action, {fmt::format("{}{}.{}", p.path, law.field, axes[k])}, "$" + parameters[k].name});
    return out;
  }
  add(p.path, p.freedoms);
  for (const subject::OtherPart& other : p.others) add(other.path, other.freedoms);
  return out;
}

Effect effect_of(const PlaceLaw& law, const subject::Place& p, bool several_legs, bool one_leg) {
  Effect e;
  const std::string words = words_of(p);
  e.name = fmt::format("{}@{}{}", law.id, one_leg ? "leg." : "", subject::id_of(p));
  e.title = fmt::format("The {}{} {}", words,
                        one_leg                       ? " of one leg"
                        : several_legs && p.in_legs() ? " of every leg"
                                                      : "",
                        law.title);
  e.scope = one_leg ? Scope::one_leg : several_legs && p.in_legs() ? Scope::all_legs : Scope::machine;
  e.parameters = law.parameters(p);
  e.edits = edits_of(law, p, e.parameters);
  for (auto page : {&EffectPages::machine, &EffectPages::data, &EffectPages::bench, &EffectPages::cure})
    e.pages.*page = with_place(law.pages.*page, words);
  e.origin = "places";
  e.place = p;
  return e;
}

bool may_be_of_one_leg(const PlaceLaw& law, const subject::Place& p) {
  return p.in_legs() && (p.others.empty() ? law.of_one_leg != OneLeg::never : law.of_one_leg == OneLeg::at_parts_alike);
}

/// What an effect does to the machine, without the names of its parameters; nothing where it has no place in it.
std::optional<std::string> key_of(const Effect& e, const subject::Subject& subject) {
  static const std::regex names(R"(\$[A-Za-z0-9_-]+)");
  std::set<std::string> edits;
  for (const EffectEdit& edit : e.edits) {
    const auto paths = outcome_of([&] { return paths_of(edit, subject); });
    if (!paths) return std::nullopt;
    for (const std::string& path : *paths)
      edits.insert(
          fmt::format("{} {} {}", path, fmt::underlying(edit.action), std::regex_replace(edit.value, names, "$$")));
  }
  return fmt::format("{} {}", e.scope == Scope::one_leg, fmt::join(edits, "; "));
}

}  // namespace

std::string words_of(const subject::Place& p) {
  const std::string name = subject::name_of(p);
  if (!p.others.empty()) return name;
  if (p.path == "rig.load_cell") return "load";
  if (p.path == "rig.sensor") return "displacement sensor";
  if (p.path.starts_with("loads.")) return "load " + p.path.substr(std::string("loads.").size());
  if (!p.path.starts_with("members.")) return name;
  const std::size_t dot = p.part.rfind('.');
  if (p.kind != subject::PlaceKind::member_end || dot == std::string::npos) return "member " + name;
  return fmt::format("{} of {}{}", p.part.substr(dot + 1), p.part.substr(0, dot), name.substr(p.part.size()));
}

std::vector<Effect> place_effects(const subject::Subject& subject, const std::vector<Effect>& named) {
  std::set<std::string> known;
  for (const Effect& e : named)
    if (const auto key = key_of(e, subject)) known.insert(*key);
  const bool several = subject.legs() > 1;
  std::vector<Effect> out;
  const auto add = [&](Effect e) {
    const auto key = key_of(e, subject);
    if (key && known.insert(*key).second) out.push_back(std::move(e));
  };
  for (const subject::Place& place : subject.places())
    for (const PlaceLaw& law : place_laws()) {
      if (!law.acts(place)) continue;
      const bool said = place.whole_section && law.action == EffectEdit::Action::multiply;
      if (!said) add(effect_of(law, place, several, false));
      if (several && may_be_of_one_leg(law, place)) add(effect_of(law, place, several, true));
    }
  return out;
}

}  // namespace deflect::effects
