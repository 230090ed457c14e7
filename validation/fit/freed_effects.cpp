// Effects whose parameters a user sets free.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "validation/fit/free_parameters.h"

namespace deflect::fit {
namespace {

double number_in_unit(std::string text, const std::string& unit) {
  if (!unit.empty() && text.ends_with(" " + unit)) text.resize(text.size() - unit.size() - 1);
  return parse_number(text);
}

}  // namespace

std::string FreedEffect::name() const { return effect->name + (leg ? fmt::format("[{}]", *leg) : ""); }

std::vector<FreeParameter> parameters_of(const subject::Subject& s, const FreedEffect& of) {
  const effects::Effect& e = *of.effect;
  if (e.parameters.empty()) throw InputError(fmt::format("the effect {} has no parameter to fit", e.name));
  if (of.leg.has_value() != (e.scope == effects::Scope::one_leg))
    throw InputError(fmt::format("the effect {} is {} one leg: {}", e.name, of.leg ? "not of" : "of",
                                 of.leg ? "leave its number out" : "give its number"));
  if (const auto reason = effects::why_not(e, s, of.leg)) throw InputError(*reason);
  std::vector<FreeParameter> out;
  for (const effects::EffectParameter& own : e.parameters) {
    FreeParameter p;
    p.path = of.name() + "." + own.name;
    p.unit = own.unit;
    p.value = own.start;
    p.positive = own.log;
    p.least = own.low, p.most = own.high;
    if (own.prior) p.prior = Prior{own.prior->mean, own.prior->deviation};
    p.of = of;
    out.push_back(std::move(p));
  }
  return out;
}

bool has_effects(const std::vector<FreeParameter>& all) {
  return std::any_of(all.begin(), all.end(), [](const FreeParameter& p) { return p.of.has_value(); });
}

std::vector<std::size_t> added_tolerances(const std::vector<subject::Tolerance>& without,
                                          const std::vector<subject::Tolerance>& with) {
  std::vector<std::size_t> out;
  std::size_t same = 0;
  for (std::size_t i = 0; i < with.size(); ++i) {
    if (same < without.size() && with[i].name == without[same].name && with[i].pose == without[same].pose)
      ++same;
    else
      out.push_back(i);
  }
  return out;
}

Prior prior_in_unit(const PriorText& text, const FreeParameter& p) {
  Prior out;
  out.mean = number_in_unit(text.mean, p.unit);
  out.deviation = text.deviation.ends_with('%') ? std::abs(out.mean) * parse_quantity(text.deviation, Dimension::ratio)
                                                : number_in_unit(text.deviation, p.unit);
  if (!(out.deviation > 0)) throw InputError("the standard deviation must be above zero");
  if (p.positive && !(out.mean > 0)) throw InputError("the mean must be above zero, as the number itself");
  return out;
}

}  // namespace deflect::fit
