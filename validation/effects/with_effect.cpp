#include "validation/effects/with_effect.h"

#include <fmt/format.h>

#include <algorithm>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/mechanism_tree.h"
#include "validation/effects/edit_paths.h"
#include "validation/effects/effect_value.h"

namespace deflect::effects {

const Mechanism& description(const DependentMechanism& d) { return d.mechanism; }
const frame::FrameDescription& description(const frame::DependentFrame& d) { return d.frame; }

namespace {

// What differs between machines and frames.
int legs_of(const Mechanism& m) { return leg_count(m); }
int legs_of(const frame::FrameDescription&) { return 0; }
std::vector<std::string> paths(const EffectEdit& edit, const Mechanism& m, std::optional<int> leg) {
  return paths_of(edit, m, leg);
}
std::vector<std::string> paths(const EffectEdit& edit, const frame::FrameDescription& f, std::optional<int>) {
  return paths_of(edit, f);
}

/// The effect's edits as edits of this description; edits whose parameters vanish are left out.
template <class Description>
std::vector<TreeEdit> edits_of(const Effect& e, const EffectEdit& edit, const Description& m, const VectorX& values,
                               std::optional<int> leg, std::size_t first) {
  const YamlNode value = parse_yaml(edit.value, e.origin);
  const std::vector<bool> used = parameters_used(value, e);
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i] && e.parameters[i].vanishes == values(as_index(i))) return {};
  static_assert(static_cast<int>(Edit::Action::add) == static_cast<int>(EffectEdit::Action::add) &&
                static_cast<int>(Edit::Action::multiply) == static_cast<int>(EffectEdit::Action::multiply));
  YamlNode filled = filled_in(value, e, values, first);
  set_line(filled, 0);
  std::vector<TreeEdit> out;
  for (const std::string& path : paths(edit, m, leg))
    out.push_back({path, filled, static_cast<Edit::Action>(edit.action)});
  return out;
}

template <class Description>
void check_arguments(const Effect& e, const Description& m, const VectorX& values, std::optional<int> leg) {
  if (as_size(values.size()) != e.parameters.size())
    throw InputError(fmt::format("effect '{}' has {} parameter{}, {} values are given", e.name, e.parameters.size(),
                                 e.parameters.size() == 1 ? "" : "s", values.size()));
  const int legs = legs_of(m);
  if (e.scope == Scope::one_leg && legs == 0)
    throw InputError(fmt::format("effect '{}' belongs to one leg: {} has none", e.name, m.name));
  if (e.scope == Scope::one_leg && !leg)
    throw InputError(fmt::format("effect '{}' belongs to one leg: say which, 1 to {}", e.name, legs));
  if (e.scope != Scope::one_leg && leg)
    throw InputError(fmt::format("effect '{}' belongs to {}: it takes no leg", e.name,
                                 e.scope == Scope::all_legs ? "all legs" : site_of({&e, {}})));
  if (leg && (*leg < 1 || *leg > legs))
    throw InputError(fmt::format("{}: there is no leg {}, legs are 1 to {}", m.name, *leg, legs));
}

/// The values, with the start of those at the end that need not be given.
VectorX with_optional(const Effect& e, const VectorX& given) {
  VectorX out = start_values(e);
  for (Eigen::Index i = given.size(); i < out.size(); ++i)
    if (!nth(e.parameters, i).optional) return given;
  if (given.size() > out.size()) return given;
  out.head(given.size()) = given;
  return out;
}

std::string line_of(const Effect& e, std::size_t edit) {
  return fmt::format("{}:{}: edits.{}: ", e.origin, e.edits[edit].line, edit);
}

/// The effect with the edits that its function computes for these values.
Effect with_computed_edits(const Effect& e, const VectorX& values) {
  Effect out = e;
  out.edits_at = nullptr;
  bool can_vanish = false, vanishes = true;
  for (std::size_t i = 0; i < e.parameters.size(); ++i) {
    if (!e.parameters[i].vanishes) continue;
    can_vanish = true;
    vanishes = vanishes && e.parameters[i].vanishes == values(as_index(i));
  }
  out.edits = can_vanish && vanishes ? std::vector<EffectEdit>() : e.edits_at(values);
  return out;
}

/// Edit by edit, so that a message can name the line that does not fit, and an edit can reach into the one before.
template <class Dependent>
Dependent one_by_one(const Dependent& m, const Effect& e, const VectorX& values, std::optional<int> leg,
                     std::size_t first) {
  Dependent so_far = m;
  for (std::size_t i = 0; i < e.edits.size(); ++i)
    so_far = told_at<InputError>([&] { return line_of(e, i); },
                                 [&] {
                                   const std::vector<TreeEdit> edits =
                                       edits_of(e, e.edits[i], description(so_far), values, leg, first);
                                   return edited_in_turn(so_far, edits);
                                 });
  return so_far;
}

/// The kind of place that the effect sits in, where the device says that nothing is missing there.
std::optional<std::string> trusted_place(const Effect& e, const std::vector<std::string>& trusted) {
  // Of several heads the first counts.
  static const std::pair<const char*, const char*> kinds[] = {
      {"base", "base"},       {"tool", "tool"},         {"payload", "load"},
      {"loads.", "load"},     {"supports.", "support"}, {"rig.load_cell.point", "load"},
      {"sensors.", "sensor"}, {"rig.sensor", "sensor"}, {"rig.load_cell", "load cell"}};
  for (const EffectEdit& edit : e.edits)
    for (const std::string& path : edit.paths) {
      const auto sits =
          std::find_if(std::begin(kinds), std::end(kinds), [&](const auto& k) { return path.starts_with(k.first); });
      if (sits != std::end(kinds) && std::find(trusted.begin(), trusted.end(), sits->second) != trusted.end())
        return sits->second;
    }
  return std::nullopt;
}

/// Without the places that the reader of the file knows: "leg.carriage: there is no 'carriage' (known: …)".
std::string reason(const std::string& message, const Effect& e) {
  std::string text = message;
  for (std::size_t i = 0; i < e.edits.size(); ++i)
    if (text.starts_with(line_of(e, i))) text = text.substr(line_of(e, i).size());
  if (const std::size_t end = text.find("': "); text.starts_with("edit '") && end != text.npos)
    text = text.substr(end + 3);
  return text;
}

template <class Dependent>
Dependent with_effect_in(const Dependent& m, const Effect& e, const VectorX& given, std::optional<int> leg,
                         std::size_t first) {
  const VectorX values = with_optional(e, given);
  check_arguments(e, description(m), values, leg);
  if (e.edits_at) return with_effect_in(m, with_computed_edits(e, values), values, leg, first);
  auto at_once = outcome_of<InputError>([&] {
    std::vector<TreeEdit> all;
    for (const EffectEdit& edit : e.edits)
      for (TreeEdit& each : edits_of(e, edit, description(m), values, leg, first)) all.push_back(std::move(each));
    return edited_in_turn(m, all);
  });
  return at_once ? std::move(*at_once) : one_by_one(m, e, values, leg, first);
}

}  // namespace

std::string site_of(const PlacedEffect& p) {
  return p.leg ? fmt::format("leg {}", *p.leg) : nth(scope_names, p.effect->scope);
}

DependentMechanism with_effect(const DependentMechanism& m, const Effect& e, const VectorX& given,
                               std::optional<int> leg, std::size_t first) {
  return with_effect_in(m, e, given, leg, first);
}

frame::DependentFrame with_effect(const frame::DependentFrame& f, const Effect& e, const VectorX& given,
                                  std::size_t first) {
  return with_effect_in(f, e, given, std::nullopt, first);
}

Mechanism with_effect(const Mechanism& m, const Effect& e, const VectorX& given, std::optional<int> leg) {
  return with_effect(DependentMechanism{m}, e, given, leg, 0).mechanism;
}

Mechanism with_effect(const Mechanism& m, const EffectInstance& i) {
  return with_effect(m, *i.effect, i.values, i.leg);
}

subject::Subject with_effect(const subject::Subject& subject, const EffectInstance& i) {
  if (subject.machine()) return with_effect(*subject.machine(), i);
  return with_effect_in(frame::DependentFrame{*subject.frame()}, *i.effect, i.values, i.leg, 0).frame;
}

std::optional<std::string> why_not(const Effect& e, const subject::Subject& subject, std::optional<int> leg) {
  if (const auto kind = trusted_place(e, subject.frame() ? subject.frame()->trusted : subject.machine()->trusted))
    return fmt::format("the {} trusts its {}", subject.frame() ? "frame" : "device", *kind);
  std::optional<std::string> first;
  const bool each = e.scope == Scope::one_leg && !leg && subject.legs() > 0;
  for (int i = 1; i <= (each ? subject.legs() : 1); ++i) {
    const EffectInstance at_start{{&e, each ? std::optional(i) : leg}, start_values(e)};
    const auto with = outcome_of<InputError>([&] { return with_effect(subject, at_start); });
    if (with) return std::nullopt;
    if (!first) first = reason(with.why, e);
  }
  return first;
}

std::vector<PlacedEffect> places_of(const Effect& e, const subject::Subject& subject) {
  std::vector<PlacedEffect> out;
  if (e.scope != Scope::one_leg) {
    if (!why_not(e, subject)) out.push_back({&e, {}});
    return out;
  }
  for (int leg = 1; leg <= subject.legs(); ++leg)
    if (!why_not(e, subject, leg)) out.push_back({&e, leg});
  return out;
}

}  // namespace deflect::effects
