#include "validation/fit/free_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/fields/tree_edit.h"
#include "msa/fields/yaml_tree.h"
#include "msa/frame/file/frame_file.h"
#include "msa/frame/file/frame_tolerances.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/numbers.h"
#include "msa/mechanism/tolerances.h"

namespace deflect::fit {
namespace {

constexpr double most_factor = 1e3, most_values = 10, most_deviations = 50;

std::vector<DescribedNumber> numbers_of(const subject::Subject& s) {
  return s.frame() ? frame::described_numbers(*s.frame()) : described_numbers(resolved(*s.machine()));
}

std::vector<NumberMove> number_moves(const subject::Subject& s) {
  return s.frame() ? frame::number_moves(*s.frame()) : deflect::number_moves(resolved(*s.machine()));
}

Edit times(const std::string& path, const char* factor) { return {path, factor, Edit::Action::multiply}; }

/// An effect with one edit that uses its one parameter.
effects::Effect effect(const std::string& path, effects::EffectEdit::Action action, effects::EffectParameter p) {
  effects::Effect out;
  out.name = path;
  out.title = path;
  out.origin = "--free";
  out.scope = effects::Scope::machine;
  out.edits = {{action, {path}, "$" + p.name, 0}};
  out.parameters = {std::move(p)};
  return out;
}

effects::Effect factor_on(const FreeParameter& p) {
  effects::EffectParameter factor{"factor", "", 1, 1 / most_factor, most_factor, true, {}, "times the value"};
  if (p.prior) factor.prior = {p.prior->mean / p.value, p.prior->deviation / p.value};
  factor.low = std::max(factor.low, p.least / p.value), factor.high = std::min(factor.high, p.most / p.value);
  return effect(p.path, effects::EffectEdit::Action::multiply, std::move(factor));
}

effects::Effect shift_of(const FreeParameter& p) {
  const double value = p.value / p.per_unit;
  double range = most_values * std::abs(value);
  effects::EffectParameter shift{"shift", p.unit, 0, -range, range, false, {}, "added to the value"};
  if (p.prior) {
    shift.prior = {p.prior->mean / p.per_unit - value, p.prior->deviation / p.per_unit};
    range = std::abs(shift.prior->mean) + most_deviations * shift.prior->deviation;
    shift.low = -range, shift.high = range;
  }
  shift.low = std::max(shift.low, (p.least - p.value) / p.per_unit);
  shift.high = std::min(shift.high, (p.most - p.value) / p.per_unit);
  return effect(p.path, effects::EffectEdit::Action::add, std::move(shift));
}

effects::Effect effect_of(const FreeParameter& p) { return p.positive ? factor_on(p) : shift_of(p); }

/// The effect that is free, with what is known of its parameters before, the first of which is all[from].
effects::Effect freed_effect(const std::vector<FreeParameter>& all, std::size_t from) {
  effects::Effect out = *all[from].of->effect;
  for (std::size_t i = 0; i < out.parameters.size(); ++i)
    if (const std::optional<Prior>& prior = all[from + i].prior)
      out.parameters[i].prior = {prior->mean, prior->deviation};
  return out;
}

/// The farthest from the value on the way to `end`, in the effect's parameter, that the description takes.
double allowed_to(const subject::Subject& s, const effects::Effect& e, double end) {
  const effects::EffectParameter& p = e.parameters.front();
  const auto refused = [&](double x) {
    return !outcome_of<InputError>([&] { return effects::with_effect(s, {{&e, {}}, VectorX::Constant(1, x)}); });
  };
  if (!refused(end)) return end;
  const auto at = [&](double share) {
    return p.log ? p.start * std::pow(end / p.start, share) : p.start + share * (end - p.start);
  };
  double inside = 0, outside = 1;
  while (outside - inside > 1e-9) {
    const double middle = 0.5 * (inside + outside);
    (refused(at(middle)) ? outside : inside) = middle;
  }
  return at(inside);
}

/// The numbers that a path moves, by index.
std::vector<std::size_t> moved_numbers(const subject::Subject& s, const std::string& path) {
  const effects::Effect e = effect(path, effects::EffectEdit::Action::multiply,
                                   {"factor", "", 1, 1 / most_factor, most_factor, true, {}, ""});
  return effects::PreparedEffects(s, {{&e, {}}}).moved_by(0);
}

/// Whether the description refuses the negative of the numbers.
bool must_be_positive(const subject::Subject& s, const std::string& path) {
  return !outcome_of<InputError>([&] { return s.edited({times(path, "-1")}); });
}

/// "GPa" where the file has "210 GPa" at the path; empty where it has none there.
std::string written_unit(const YamlNode& file, const std::string& path) {
  const auto found = outcome_of<InputError>([&] { return places(file, path, ""); });
  if (!found || found->empty()) return "";
  const std::string& text = at(file, found->front()).text;
  const std::size_t space = text.find(' ');
  return space == text.npos ? "" : text.substr(text.find_first_not_of(' ', space));
}

void take_unit(FreeParameter& p, const YamlNode& file) {
  const std::vector<std::string> known = units_of(p.dimension);
  if (known.empty() || p.dimension == Dimension::ratio) return;
  const std::string written = written_unit(file, p.path);
  p.unit = std::find(known.begin(), known.end(), written) != known.end() ? written : known.front();
  p.per_unit = parse_quantity("1 " + p.unit, p.dimension);
}

/// Each leg of a machine has numbers of its own. Those under "leg", from which they were copied, are not the model's.
void leave_out_copied(std::vector<std::size_t>& moved, const std::vector<DescribedNumber>& all) {
  if (std::any_of(moved.begin(), moved.end(), [&](std::size_t i) { return all[i].path.starts_with("leg["); }))
    std::erase_if(moved, [&](std::size_t i) { return all[i].path.starts_with("leg."); });
}

void take_values(FreeParameter& p, const subject::Subject& s) {
  const std::vector<DescribedNumber> all = numbers_of(s);
  p.numbers = moved_numbers(s, p.path);
  leave_out_copied(p.numbers, all);
  if (p.numbers.empty())
    throw InputError("no number of the model follows from it: name a number that the model is computed from");
  const DescribedNumber& first = all[p.numbers.front()];
  p.common = std::any_of(p.numbers.begin(), p.numbers.end(), [&](std::size_t i) {
    return std::abs(all[i].value - first.value) > 1e-12 * std::abs(first.value);
  });
  p.dimension = p.common ? Dimension::none : first.dimension;
  p.value = p.common ? 1 : first.value;
}

void require_apart(const std::vector<FreeParameter>& all) {
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      for (const std::size_t number : all[i].numbers)
        if (std::find(all[k].numbers.begin(), all[k].numbers.end(), number) != all[k].numbers.end())
          throw InputError(fmt::format("--free {}: --free {} moves the same number: leave one of them out", all[i].path,
                                       all[k].path));
}

Prior parsed(const PriorText& text, const FreeParameter& p) {
  Prior out;
  out.mean = text.mean == "0" ? 0 : parse_quantity(text.mean, p.dimension);  // in every unit
  out.deviation = text.deviation.ends_with('%') ? std::abs(out.mean) * parse_quantity(text.deviation, Dimension::ratio)
                                                : parse_quantity(text.deviation, p.dimension);
  if (!(out.deviation > 0)) throw InputError("the standard deviation must be above zero");
  if (p.positive && !(out.mean > 0)) throw InputError("the mean must be above zero, as the number itself");
  return out;
}

void take_priors(std::vector<FreeParameter>& all, const std::vector<std::string>& priors) {
  std::vector<std::string> paths;
  for (const FreeParameter& p : all) paths.push_back(p.path);
  for (const std::string& given : priors) {
    const PriorText text = prior_text(given);
    const auto p =
        std::find_if(all.begin(), all.end(), [&](const FreeParameter& each) { return each.path == text.path; });
    if (p == all.end())
      throw InputError(
          fmt::format("--prior '{}': '{}' is not among --free{}", given, text.path, suggestion(text.path, paths)));
    if (p->prior) throw InputError(fmt::format("--prior '{}': '{}' has a prior already", given, text.path));
    p->prior = told_at<InputError>([&] { return fmt::format("--prior '{}': ", given); },
                                   [&] { return p->of ? prior_in_unit(text, *p) : parsed(text, *p); });
  }
}

/// Whether the tolerance moves every number that the parameter does.
bool moves_all_of(const NumberMove& move, const FreeParameter& p) {
  return !p.of && std::all_of(p.numbers.begin(), p.numbers.end(), [&](std::size_t number) {
    return std::any_of(move.shifts.begin(), move.shifts.end(), [&](const auto& each) { return each.first == number; });
  });
}

/// A machine has one tolerance of the moduli of all members: it is free where every material's E is.
bool every_modulus_is_free(const subject::Subject& s, const std::vector<FreeParameter>& all) {
  const std::vector<DescribedNumber> numbers = numbers_of(s);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!numbers[i].path.starts_with("materials.") || !numbers[i].path.ends_with(".E")) continue;
    if (std::none_of(all.begin(), all.end(), [&](const FreeParameter& p) {
          return std::find(p.numbers.begin(), p.numbers.end(), i) != p.numbers.end();
        }))
      return false;
  }
  return true;
}

std::string trimmed(const std::string& text) {
  const std::size_t from = text.find_first_not_of(' ');
  return from == text.npos ? "" : text.substr(from, text.find_last_not_of(' ') - from + 1);
}

}  // namespace

double FreeParameter::coordinate(double p) const { return positive ? std::log(p) : p; }
double FreeParameter::value_at(double x) const { return positive ? std::exp(x) : x; }
double FreeParameter::scale() const {
  if (positive) return 1;
  if (value != 0) return std::abs(value);
  return prior ? prior->deviation : 0.1 * (most - least);
}

double search_range(const FreeParameter& p) {
  if (p.of) return p.coordinate(p.most) - p.coordinate(p.least);
  const effects::Effect e = effect_of(p);
  const effects::EffectParameter& own = e.parameters.front();
  return p.positive ? std::log(own.high / own.low) : p.per_unit * (own.high - own.low);
}

FreeParameter bounded(FreeParameter p, const subject::Subject& s) {
  if (p.of) return p;
  p.least = -std::numeric_limits<double>::infinity(), p.most = std::numeric_limits<double>::infinity();
  const effects::Effect e = effect_of(p);
  const effects::EffectParameter& own = e.parameters.front();
  const auto value = [&](double x) { return p.positive ? p.value * x : p.value + p.per_unit * x; };
  p.least = value(allowed_to(s, e, own.low)), p.most = value(allowed_to(s, e, own.high));
  return p;
}

PriorText prior_text(const std::string& given) {
  const std::size_t equals = given.find('=');
  for (const std::string sign : {"±", "+-", "+/-"})
    if (const std::size_t at = given.find(sign); equals != given.npos && at != given.npos && at > equals) {
      const PriorText out{trimmed(given.substr(0, equals)), trimmed(given.substr(equals + 1, at - equals - 1)),
                          trimmed(given.substr(at + sign.size()))};
      if (!out.path.empty() && !out.mean.empty() && !out.deviation.empty()) return out;
    }
  throw InputError(
      fmt::format("--prior '{}': write PATH=mean ± standard deviation, as in \"materials.steel.E=210 GPa ± "
                  "5 %\" (+- for ±)",
                  given));
}

FreeParameter parameter_at(const subject::Subject& s, const std::string& path, const std::string& yaml) {
  FreeParameter p;
  p.path = path;
  s.edited({times(path, "1")});
  take_values(p, s);
  take_unit(p, yaml.empty() ? YamlNode() : parse_yaml(yaml, s.name()));
  p.positive = p.value > 0 && (p.common || must_be_positive(s, path));
  return p;
}

std::vector<FreeParameter> free_parameters(const subject::Subject& s, const std::vector<std::string>& paths,
                                           const std::vector<std::string>& priors, const std::string& yaml,
                                           const std::map<std::string, FreedEffect>& effects) {
  if (paths.empty()) throw InputError("name the parameters to fit: --free materials.steel.E");
  std::vector<FreeParameter> out, of_effects;
  for (const std::string& path : paths)
    told_at<InputError>([&] { return fmt::format("--free {}: ", path); },
                        [&] {
                          const auto effect = effects.find(path);
                          if (effect == effects.end()) return out.push_back(parameter_at(s, path, yaml));
                          for (FreeParameter& p : parameters_of(s, effect->second)) of_effects.push_back(std::move(p));
                          if (std::count(paths.begin(), paths.end(), path) > 1)
                            throw InputError("the effect is named twice: name it once");
                        });
  require_apart(out);
  out.insert(out.end(), of_effects.begin(), of_effects.end());
  take_priors(out, priors);
  for (const FreeParameter& p : out)
    if (p.value == 0 && !p.prior && !p.of)
      throw InputError(
          fmt::format("--free {0}: the value is 0, which tells no scale: give it by --prior \"{0}=0 ± …\"", p.path));
  for (FreeParameter& p : out) p = bounded(std::move(p), s);
  return out;
}

std::vector<FreeParameter> in_version(std::vector<FreeParameter> all, const VectorX& values) {
  for (std::size_t i = 0; i < all.size(); ++i) all[i].value = values(as_index(i));
  return all;
}

VectorX first_numbers(const subject::Subject& s, const std::vector<FreeParameter>& all) {
  const std::vector<DescribedNumber> numbers = numbers_of(s);
  VectorX out(std::ssize(all));
  for (std::size_t i = 0; i < all.size(); ++i)
    out(as_index(i)) = all[i].of ? all[i].value : numbers.at(all[i].numbers.front()).value;
  return out;
}

namespace {

subject::Subject with_those(const subject::Subject& s, const std::vector<FreeParameter>& all, const VectorX& values,
                            bool effects_too) {
  const Freed freed(all);
  const VectorX of_effects = freed.effect_values(values);
  subject::Subject out = s;
  std::size_t from = 0;
  for (const effects::PlacedEffect& each : freed.hypothesis()) {
    const std::size_t count = each.effect->parameters.size();
    if (effects_too || !all[from].of)
      out = effects::with_effect(out, {each, of_effects.segment(as_index(from), as_index(count))});
    from += count;
  }
  return out;
}

}  // namespace

subject::Subject with_values(const subject::Subject& s, const std::vector<FreeParameter>& all, const VectorX& values) {
  return with_those(s, all, values, true);
}

subject::Subject with_numbers(const subject::Subject& s, const std::vector<FreeParameter>& all, const VectorX& values) {
  return with_those(s, all, values, false);
}

std::vector<std::size_t> replaced_tolerances(const subject::Subject& s, const std::vector<FreeParameter>& all,
                                             const std::vector<subject::Tolerance>& tolerances) {
  std::vector<std::string> names;
  for (const NumberMove& move : number_moves(s))
    for (const FreeParameter& p : all)
      if (moves_all_of(move, p)) names.push_back(move.name);
  if (s.machine() && every_modulus_is_free(s, all)) names.emplace_back("modulus");
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < tolerances.size(); ++i)
    if (!tolerances[i].pose && std::find(names.begin(), names.end(), tolerances[i].name) != names.end())
      out.push_back(i);
  return out;
}

std::optional<double> declared_deviation(const subject::Subject& s, const FreeParameter& p) {
  if (p.of) return std::nullopt;
  const double first = first_numbers(s, {p})(0);
  for (const NumberMove& move : number_moves(s)) {
    if (!moves_all_of(move, p)) continue;
    for (const auto& [number, shift] : move.shifts)
      if (number == p.numbers.front()) return std::abs(p.positive ? shift / first : shift);
  }
  if (!s.machine() || !every_modulus_is_free(s, {p})) return std::nullopt;
  const double modulus = named_tolerances(*s.machine()).modulus;
  return modulus > 0 ? std::optional(modulus) : std::nullopt;
}

Freed::Freed(const std::vector<FreeParameter>& all) : parameters_(all) {
  for (std::size_t i = 0; i < all.size(); i += effects_.back().parameters.size())
    effects_.push_back(all[i].of ? freed_effect(all, i) : effect_of(all[i]));
}

diagnosis::Hypothesis Freed::hypothesis() const {
  diagnosis::Hypothesis out;
  std::size_t from = 0;
  for (const effects::Effect& e : effects_) {
    const std::optional<FreedEffect>& of = parameters_[from].of;
    out.push_back({&e, of ? of->leg : std::nullopt});
    from += e.parameters.size();
  }
  return out;
}

VectorX Freed::effect_values(const VectorX& values) const {
  VectorX out(values.size());
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const FreeParameter& p = nth(parameters_, i);
    out(i) = p.of ? values(i) : p.positive ? values(i) / p.value : (values(i) - p.value) / p.per_unit;
  }
  return out;
}

VectorX Freed::values(const VectorX& of_effects) const {
  VectorX out(of_effects.size());
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const FreeParameter& p = nth(parameters_, i);
    out(i) = p.of ? of_effects(i) : p.positive ? p.value * of_effects(i) : p.value + p.per_unit * of_effects(i);
  }
  return out;
}

}  // namespace deflect::fit
