#include "tests/attack/pipeline_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/support/effects.h"
#include "validation/effects/place_effects.h"

namespace deflect::attack {
namespace {

constexpr double rounding = 1e-9;

class Checks {
 public:
  explicit Checks(std::vector<Contradiction>& wrong) : wrong_(wrong) {}

  template <class... T>
  void require(bool right, const char* check, fmt::format_string<T...> words, T&&... values) {
    if (!right) wrong_.push_back({check, fmt::format(words, std::forward<T>(values)...)});
  }
  void share(const Json& value, const char* check) {
    require(value.is_number() && value.get<double>() >= 0 && value.get<double>() <= 1 + rounding, check, "{}",
            value.dump());
  }
  void not_negative(const Json& value, const char* check) {
    require(value.is_number() && value.get<double>() >= 0, check, "{}", value.dump());
  }

 private:
  std::vector<Contradiction>& wrong_;
};

void check_quality(Checks& c, const Json& q, const char* check) {
  for (const char* name : {"rmse_mm", "held_out_rmse_mm", "chi2_per_dof"}) c.not_negative(q[name], check);
}

void check_probabilities(Checks& c, const Json& d) {
  const Json& candidates = d["candidates"];
  double sum = d["probability_nothing"].get<double>() + d["probability_unknown"].get<double>(), before = 1;
  c.share(d["probability_nothing"], "a probability of nothing");
  c.share(d["probability_unknown"], "a probability of the unknown");
  c.share(d["chance_of_any"], "a chance");
  for (const Json& each : candidates) {
    c.share(each["probability"], "a probability");
    const auto p = each["probability"].get<double>();
    c.require(p <= before + rounding, "order of candidates", "{} after {}", p, before);
    sum += before = p;
  }
  c.require(std::abs(sum - 1) < 1e-6, "probabilities", "sum {}", sum);
}

void check_verdict(Checks& c, const Json& d) {
  const std::string verdict = d["verdict"];
  const bool left = d["unexplained"]["significant"];
  const Json& ties = d["indistinguishable"];
  std::string wanted = left ? "unknown_effect" : d["missing"].empty() ? "nothing_missing" : "effect";
  if (wanted == "effect" && !ties.empty()) wanted = "ambiguous";
  c.require(verdict == wanted, "verdict", "{}, where missing, ties and the rest say {}", verdict, wanted);
  std::vector<std::string> found;
  std::set<std::pair<std::string, int>> once;
  for (const Json& each : d["found"]) {
    found.push_back(each["effect"]);
    c.require(once.insert({found.back(), each.value("leg", 0)}).second, "named twice", "{} in {}", found.back(),
              d["found"].dump());
  }
  c.require(d["missing"].get<std::vector<std::string>>() == found, "found", "{} found of {}", d["found"].dump(),
            d["missing"].dump());
  for (const Json& tie : ties)
    c.require(left || std::find(found.begin(), found.end(), tie.front().get<std::string>()) != found.end(), "tie",
              "{} begins with what was not found, {}", tie.dump(), d["found"].dump());
  if (found.size() == 1 && verdict != "unknown_effect") {
    double most = 0, tied = 0;  // of its places; of those that cannot be told from it
    for (const Json& each : d["candidates"]) {
      const std::string& effect = each["effect"].get_ref<const std::string&>();
      const double probability = each["probability"];
      if (effect == found.front()) most = std::max(most, probability);
      if (effect != found.front() && std::any_of(ties.begin(), ties.end(), [&](const Json& tie) {
            return std::find(tie.begin(), tie.end(), effect) != tie.end();
          }))
        tied += probability;
    }
    const double nothing = d["probability_nothing"];
    c.require(most + tied >= nothing || nothing < 0.01, "named, though nothing is likelier",
              "{} with {}, in a tie with {}, nothing with {}", found.front(), most, tied, nothing);
  }
  for (const Json& tie : ties) {
    const bool holds = std::any_of(found.begin(), found.end(), [&](const auto& name) {
      return std::find(tie.begin(), tie.end(), name) != tie.end();
    });
    c.require(tie.size() > 1 && holds, "tie", "{} with {}", tie.dump(), fmt::join(found, ", "));
  }
}

/// One parameter: low ≤ value ≤ high, all within the bounds.
void check_parameter(Checks& c, const std::string& effect, const effects::EffectParameter& p, const Json& given) {
  const std::string words = fmt::format("{}: {} in {:g} … {:g}", effect, given.dump(), p.low, p.high);
  for (const char* name : {"value", "low95", "high95"})
    c.require(given[name].is_number(), "a parameter without number", "{}", words);
  if (!given["value"].is_number() || !given["low95"].is_number() || !given["high95"].is_number()) return;
  const double value = given["value"], low = given["low95"], high = given["high95"];
  const double room = rounding * (std::abs(value) + std::abs(low) + std::abs(high));
  c.require(low <= value + room && value <= high + room, "value outside its interval", "{}", words);
  c.require(value >= p.low - room && value <= p.high + room, "value outside its bounds", "{}", words);
  c.require(low >= p.low - room && high <= p.high + room, "interval outside its bounds", "{}", words);
}

void check_parameters(Checks& c, const Json& of, const std::vector<effects::Effect>& all) {
  const std::string name = of["effect"];
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& e) { return e.name == name; });
  c.require(found != all.end(), "an effect that nobody knows", "{}", name);
  if (found == all.end()) return;
  const Json& parameters = of["parameters"];
  c.require(parameters.empty() || parameters.size() == found->parameters.size(), "parameters", "{}", of.dump());
  for (std::size_t i = 0; i < std::min(parameters.size(), found->parameters.size()); ++i)
    check_parameter(c, name, found->parameters[i], parameters[i]);
}

/// χ² of the end over the numbers. The diagnosis divides it by the numbers less the values that it fitted; to `history`
/// these are given.
double final_chi2(const Json& d, double numbers) {
  double values = 0;
  for (const Json& each : d["found"]) values += static_cast<double>(each["parameters"].size());
  return d["final"]["chi2_per_dof"].get<double>() * std::max(1.0, numbers - values) / numbers;
}

}  // namespace

void check_comparison(const Json& j, std::vector<Contradiction>& wrong) {
  Checks c(wrong);
  c.not_negative(j["baseline"]["rmse_mm"], "rmse of compare");
  c.not_negative(j["baseline"]["chi2_per_dof"], "chi2 of compare");
  c.not_negative(j["noise_floor_mm"], "noise of compare");
  for (const Json& f : j["findings"]) {
    c.share(f["p_value"], "p-value of a finding");
    c.share(f["share_of_misfit"], "share of a finding");
    c.not_negative(f["size_mm"], "size of a finding");
    c.require(!f["sentence"].get<std::string>().empty(), "finding without a sentence", "{}", f.dump());
  }
  for (const Json& p : j["patterns"]) c.share(p["p_value"], "p-value of a pattern");
}

void check_diagnosis(const Json& d, const subject::Subject& subject, double numbers,
                     std::vector<Contradiction>& wrong) {
  Checks c(wrong);
  check_quality(c, d["baseline"], "quality without effects");
  check_quality(c, d["final"], "quality with effects");
  c.not_negative(d["noise_floor_mm"], "noise floor");
  c.share(d["unexplained"]["share_of_misfit"], "share unexplained");
  c.require(!d["sentence"].get<std::string>().empty(), "a verdict without a sentence", "{}", d["verdict"].dump());
  check_probabilities(c, d);
  check_verdict(c, d);
  std::vector<effects::Effect> all = test::all_effects();
  for (effects::Effect& e : effects::place_effects(subject, all)) all.push_back(std::move(e));
  for (const Json& each : d["candidates"]) {
    check_parameters(c, each, all);
    check_quality(c, each, "quality of a candidate");
  }
  for (const Json& each : d["found"]) {
    c.require(!each["parameters"].empty(), "found without values", "{}", each.dump());
    check_parameters(c, each, all);
  }
  const double before = d["baseline"]["chi2_per_dof"], after = final_chi2(d, numbers);
  if (!d["missing"].empty()) c.require(after < before, "misfit that does not fall", "{} to {}", before, after);
}

void check_history(const Json& h, const Json& d, double numbers, bool noise_is_told,
                   std::vector<Contradiction>& wrong) {
  Checks c(wrong);
  const Json& versions = h["versions"];
  c.require(versions.size() == 2, "versions", "{}", versions.size());
  for (const Json& v : versions) check_quality(c, v, "quality of a version");
  // What one sets aside and the other keeps is not to be compared.
  for (const Json& v : versions)
    if (v["set_aside_lines"].size() != d["set_aside"]) return;
  const double before = d["baseline"]["chi2_per_dof"], after = final_chi2(d, numbers);
  const double first = versions[0]["chi2_beside_deformed_shape"], second = versions[1]["chi2_beside_deformed_shape"];
  // Where the diagnosis has widened the tolerances its misfit is a smaller one, by their square at most.
  const double scale = d["tolerance_scale"], widened = scale * scale;
  if (!noise_is_told) {
    // History takes it from what each version leaves, the diagnosis from what the last one leaves: then the errors are
    // compared.
    const double left = d["final"]["rmse_mm"], followed = versions[1]["kept_rmse_mm"];
    constexpr double rounding = 1e-12;  // mm, N, of hundreds of N: what a member without a load reads
    const double off = 0.1 * left + 0.02 * d["baseline"]["rmse_mm"].get<double>() + rounding;
    c.require(std::abs(followed - left) <= off, "error after, by history", "{} for {}", followed, left);
    return;
  }
  c.require(first >= 0.9 * before && first <= 1.1 * widened * before, "misfit before, by history",
            "{} for {} with tolerances {} times as wide", first, before, scale);
  c.require(second >= 0.9 * after - 0.02 * before && second <= 1.1 * widened * after + 0.02 * before,
            "misfit after, by history", "{} for {}", second, after);
}

}  // namespace deflect::attack
