#include "validation/report/effect_results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "msa/base/index.h"
#include "validation/effects/parameter_unit.h"
#include "validation/json/json_text.h"
#include "validation/report/text.h"

namespace deflect::report {
namespace {

constexpr const char* action_names[] = {"set", "append", "multiply", "add"};

const char* scope_name(const effects::Effect& e) { return nth(effects::scope_names, e.scope); }
const char* action_name(const effects::EffectEdit& e) { return nth(action_names, e.action); }

std::string parameter_names(const effects::Effect& e) {
  std::string text;
  for (const effects::EffectParameter& p : e.parameters) text += (text.empty() ? "" : " ") + p.name;
  return text.empty() ? "no parameter" : text;
}

std::string row(const std::string& name, const std::string& scope, const std::string& text) {
  return fmt::format("{:<24} {:<9} {}\n", name, scope, text);
}

std::string headed_paragraph(const std::string& heading, const std::string& text) {
  std::string out = heading + "\n";
  for (const std::string& line : wrap(text, line_length - 2)) out += "  " + line + "\n";
  return out;
}

std::string parameter_text(const effects::EffectParameter& p) {
  const std::string unit = effects::printed_unit(p.name);
  std::string absent;
  if (p.vanishes)
    absent = std::isfinite(*p.vanishes) ? fmt::format(", absent at {:g}", *p.vanishes) : ", absent at infinity";
  return fmt::format("  {}: {}\n    from {:g} to {:g}{}{}, search begins at {:g}{}{}\n", p.name, p.about, p.low, p.high,
                     unit.empty() ? "" : " ", unit, p.start, p.log ? ", logarithmic" : "", absent);
}

Json parameter_json(const effects::EffectParameter& p) {
  Json j = {{"name", p.name}, {"unit", effects::printed_unit(p.name)}, {"start", p.start}, {"low", p.low},
            {"high", p.high}, {"scale", p.log ? "log" : "linear"}};
  if (p.vanishes && std::isfinite(*p.vanishes)) j["vanishes"] = *p.vanishes;
  if (p.vanishes && !std::isfinite(*p.vanishes)) j["vanishes"] = "infinity";
  j["about"] = p.about;
  return j;
}

Json effect_json(const effects::Effect& e) {
  Json j = {{"effect", e.name}, {"title", e.title}, {"scope", scope_name(e)}, {"parameters", Json::array()}};
  for (const effects::EffectParameter& p : e.parameters) j["parameters"].push_back(parameter_json(p));
  j["edits"] = Json::array();
  for (const effects::EffectEdit& edit : e.edits)
    j["edits"].push_back({{"at", edit.paths}, {"action", action_name(edit)}, {"value", edit.value}});
  j["pages"] = {{"machine", e.pages.machine}, {"data", e.pages.data}, {"bench", e.pages.bench}, {"cure", e.pages.cure}};
  if (!e.see.empty()) j["see"] = e.see;
  if (e.place) j["place"] = place_json(*e.place, std::nullopt);
  return j;
}

/// One line for each place: its laws; those that may sit in one leg alone.
std::string laws_at_places(const std::vector<effects::Effect>& all, const subject::Subject& subject) {
  std::vector<std::string> order;
  std::map<std::string, std::string> kinds, laws, of_one_leg;
  for (const effects::Effect& e : all) {
    if (!e.place) continue;
    const std::string id = subject::id_of(*e.place), law = e.name.substr(0, e.name.find('@'));
    if (std::find(order.begin(), order.end(), id) == order.end()) order.push_back(id);
    kinds[id] = nth(subject::place_kind_names, e.place->kind);
    (e.scope == effects::Scope::one_leg ? of_one_leg : laws)[id] += law + " ";
  }
  if (order.empty()) return "";
  std::string out = fmt::format(
      "laws at its places: LAW@PLACE, of one leg LAW@leg.PLACE; 'deflect effects LAW@PLACE --device {}' explains one\n",
      subject.name());
  for (const std::string& id : order)
    out += fmt::format("  {:<24} {:<9} {}{}\n", id, kinds[id], laws[id],
                       of_one_leg[id].empty() ? "" : "| of one leg: " + of_one_leg[id]);
  return out;
}

}  // namespace

Json place_json(const subject::Place& p, std::optional<int> leg) {
  Json out = {{"kind", nth(subject::place_kind_names, p.kind)}, {"part", p.part}, {"path", p.path}};
  if (const std::string motion = subject::motion_of(p); !motion.empty()) out["motion"] = motion;
  if (leg) out["leg"] = *leg;
  for (const subject::OtherPart& other : p.others) out["also"].push_back(other.path);
  return out;
}

std::string effect_table(const std::vector<effects::Effect>& all) {
  std::string out = row("effect", "scope", "what is missing, and its parameters");
  for (const effects::Effect& e : all)
    out += row(e.name, scope_name(e), e.title) + row("", "", "  " + parameter_names(e));
  return out;
}

std::string effects_in_device(const std::vector<effects::Effect>& all, const subject::Subject& subject) {
  std::string there = fmt::format("effects that {} can have\n", subject.name()), not_there;
  for (const effects::Effect& e : all)
    if (e.place)
      continue;
    else if (const auto reason = effects::why_not(e, subject))
      not_there += fmt::format("  {:<24} {}\n", e.name, *reason);
    else
      there += fmt::format("  {:<24} {:<9} {}\n", e.name, scope_name(e), parameter_names(e));
  return there + (not_there.empty() ? "" : "effects that it cannot have, and why\n" + not_there) +
         laws_at_places(all, subject);
}

std::string effect_page(const effects::Effect& e) {
  std::string out = fmt::format("{}\n{}. Scope: {}.\n\n", e.name, e.title, scope_name(e));
  out += headed_paragraph("In the machine", e.pages.machine) + headed_paragraph("In the data", e.pages.data) +
         headed_paragraph("On the bench", e.pages.bench) + headed_paragraph("Cure", e.pages.cure);
  if (!e.parameters.empty()) out += "Parameters\n";
  for (const effects::EffectParameter& p : e.parameters) out += parameter_text(p);
  out += "Edits of the description\n";
  for (const effects::EffectEdit& edit : e.edits)
    out += fmt::format("  {} {} {}\n", fmt::join(edit.paths, " or "), action_name(edit), edit.value);
  if (!e.see.empty()) out += headed_paragraph("See", e.see);
  return out;
}

std::string effects_json(const std::vector<effects::Effect>& all, const std::optional<subject::Subject>& device) {
  Json list = Json::array();
  for (const effects::Effect& e : all) {
    Json j = effect_json(e);
    if (device) {
      const auto reason = effects::why_not(e, *device);
      j["applies"] = !reason;
      if (reason) j["reason"] = *reason;
    }
    list.push_back(std::move(j));
  }
  return json::json_text(list);
}

std::string words(const effects::EffectInstance& i) {
  std::string out = i.effect->name, values;
  if (i.leg) out += fmt::format(" of leg {}", *i.leg);
  for (std::size_t k = 0; k < i.effect->parameters.size(); ++k)
    values += fmt::format("{}{} = {:.6g}", k > 0 ? ", " : "", i.effect->parameters[k].name, i.values(as_index(k)));
  return values.empty() ? out : fmt::format("{} ({})", out, values);
}

namespace {

Json instances_json(const std::vector<effects::EffectInstance>& all) {
  Json out = Json::array();
  for (const effects::EffectInstance& i : all) {
    Json parameters = Json::array();
    for (std::size_t k = 0; k < i.effect->parameters.size(); ++k)
      parameters.push_back({{"name", i.effect->parameters[k].name}, {"value", i.values(as_index(k))}});
    Json one = {{"effect", i.effect->name}, {"site", effects::site_of(i)}};
    if (i.leg) one["leg"] = *i.leg;
    one["parameters"] = parameters;
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace

std::string added_json(const std::string& device, const std::string& new_device,
                       const std::vector<effects::EffectInstance>& added) {
  return json::json_text(
      Json{{"kind", "addition"}, {"device", device}, {"new_device", new_device}, {"added", instances_json(added)}});
}

std::string simulated_json(const std::string& device, const std::string& data, std::size_t readings, std::size_t poses,
                           const std::vector<effects::EffectInstance>& hidden, std::uint64_t seed) {
  return json::json_text(Json{{"kind", "simulation"},
                              {"device", device},
                              {"data", data},
                              {"readings", readings},
                              {"poses", poses},
                              {"seed", seed},
                              {"hidden", instances_json(hidden)}});
}

}  // namespace deflect::report
