#include "validation/diagnosis/found_effects.h"

#include <fmt/format.h>

#include <algorithm>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/index.h"
#include "msa/fields/yaml_tree.h"
#include "validation/json/json_text.h"
#include "validation/measurement/column_names.h"

namespace deflect::diagnosis {
namespace {

class Reader {
 public:
  Reader(const std::string& text, const std::string& origin)
      : file_(origin), root_(json::parse_json(text, origin, "give the file of 'deflect diagnose --json'")) {}

  FoundEffects read() const {
    FoundEffects out;
    const Json& candidates = list(root_, "candidates", "");
    for (std::size_t i = 0; i < candidates.size(); ++i)
      out.candidates.push_back(hypothesis(candidates[i], fmt::format("candidates[{}]", i)));
    const Json& missing = list(root_, "missing", "");
    for (std::size_t i = 0; i < missing.size(); ++i) {
      const std::string where = fmt::format("missing[{}]", i);
      out.missing.push_back(missing[i].is_string() ? named(missing[i]) : hypothesis(missing[i], where));
    }
    if (root_.contains("found")) take_found(out.missing);
    for (FoundEffect& f : out.missing) complete(f, out.candidates);
    if (root_.contains("ties")) out.ties = ties();
    out.data = text("/data");
    out.verdict = text("/verdict");
    out.unexplained = text("/unexplained/pattern");
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    throw InputError(fmt::format("{}: {}: {}", file_, where, what));
  }

  /// Legs and values of what is missing, fitted together: of several effects each alone has others.
  void take_found(std::vector<FoundEffect>& missing) const {
    const Json& found = list(root_, "found", "");
    for (std::size_t i = 0; i < std::max(found.size(), missing.size()); ++i) {
      const std::string where = fmt::format("found[{}]", i);
      if (i >= found.size() || i >= missing.size())
        fail(where,
             fmt::format("'missing' names {} effects, 'found' {}: each has its entry", missing.size(), found.size()));
      FoundEffect f = hypothesis(found[i], where);
      if (f.effect != missing[i].effect)
        fail(where, fmt::format("is '{}', where 'missing' has '{}'", f.effect, missing[i].effect));
      missing[i] = std::move(f);
    }
  }

  std::vector<FoundTie> ties() const {
    std::vector<FoundTie> out;
    const Json& all = list(root_, "ties", "");
    for (std::size_t i = 0; i < all.size(); ++i) {
      FoundTie& tie = out.emplace_back();
      const std::string where = fmt::format("ties[{}]", i);
      const Json& rivals = list(all[i], "rivals", where);
      for (std::size_t k = 0; k < rivals.size(); ++k) {
        const std::string rival = fmt::format("{}.rivals[{}]", where, k);
        FoundTie::Rival& r = tie.rivals.emplace_back();
        if (!rivals[k].is_object() || !rivals[k].contains("probability") || !rivals[k]["probability"].is_number())
          fail(rival, "has no 'probability'");
        r.probability = rivals[k]["probability"];
        const Json& effects = list(rivals[k], "effects", rival);
        for (std::size_t e = 0; e < effects.size(); ++e)
          r.effects.push_back(hypothesis(effects[e], fmt::format("{}.effects[{}]", rival, e)));
        if (r.effects.empty()) fail(rival, "has no effects");
      }
    }
    return out;
  }

  /// Empty where it is not there.
  std::string text(const char* pointer) const {
    const Json::json_pointer at(pointer);
    return root_.contains(at) && root_.at(at).is_string() ? root_.at(at).get<std::string>() : "";
  }

  static FoundEffect named(const Json& name) { return {name.get<std::string>(), {}, {}}; }

  const Json& list(const Json& in, const char* key, const std::string& where) const {
    const std::string path = where.empty() ? key : fmt::format("{}.{}", where, key);
    if (!in.is_object() || !in.contains(key) || !in[key].is_array())
      fail(path, "a list is wanted, as 'deflect diagnose --json' writes it");
    return in[key];
  }

  /// "leg" is the place as a number; results of versions before have it in the words of "site" alone.
  std::optional<int> leg(const Json& in, const std::string& where) const {
    constexpr int most = 1000;
    if (in.contains("leg")) {
      const Json& number = in["leg"];
      if (!number.is_number_integer() || number < 1 || number > most)
        fail(where + ".leg",
             fmt::format("is {}: the number of a leg is wanted, from 1", measurement::excerpt(number.dump())));
      return number.get<int>();
    }
    if (!in.contains("site") || !in["site"].is_string()) return std::nullopt;
    const std::string site = in["site"];
    if (!site.starts_with("leg ")) return std::nullopt;
    for (int number = 1; number <= most; ++number)
      if (site == fmt::format("leg {}", number)) return number;
    fail(where + ".site", fmt::format("there is no '{}': legs are numbered from 1", measurement::excerpt(site)));
  }

  FoundEffect hypothesis(const Json& in, const std::string& where) const {
    if (!in.is_object() || !in.contains("effect") || !in["effect"].is_string()) fail(where, "has no 'effect'");
    FoundEffect found = named(in["effect"]);
    found.leg = leg(in, where);
    if (!in.contains("parameters")) return found;
    const Json& parameters = list(in, "parameters", where);
    for (const Json& p : parameters) {
      if (!p.is_object() || !p.contains("name") || !p["name"].is_string() || !p.contains("value") ||
          !p["value"].is_number())
        fail(where + ".parameters", R"(each is {"name": ..., "value": number})");
      found.parameters.emplace_back(p["name"], p["value"]);
    }
    return found;
  }

  /// Values and leg from the best candidate of that effect, where they are not given.
  static void complete(FoundEffect& found, const std::vector<FoundEffect>& candidates) {
    for (const FoundEffect& c : candidates) {
      if (c.effect != found.effect || (found.leg && c.leg != found.leg)) continue;
      if (!found.leg) found.leg = c.leg;
      if (found.parameters.empty()) found.parameters = c.parameters;
      return;
    }
  }

  std::string file_;
  Json root_;
};

}  // namespace

FoundEffects parse_found_effects(const std::string& json, const std::string& origin) {
  return Reader(json, origin).read();
}

FoundEffects read_found_effects(const std::filesystem::path& path) {
  return parse_found_effects(read_text(path), path.string());
}

effects::EffectInstance instance(const effects::Effect& e, const FoundEffect& found) {
  std::vector<std::string> names;
  for (const effects::EffectParameter& p : e.parameters) names.push_back(p.name);
  for (const auto& [name, value] : found.parameters)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw InputError(fmt::format("effect '{}' has no parameter '{}'{}", e.name, name, suggestion(name, names)));

  effects::EffectInstance out{{&e, found.leg}, effects::start_values(e)};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const effects::EffectParameter& p = e.parameters[i];
    const auto at = std::find_if(found.parameters.begin(), found.parameters.end(),
                                 [&](const auto& given) { return given.first == p.name; });
    if (at == found.parameters.end() && p.optional) continue;
    if (at == found.parameters.end())
      throw InputError(fmt::format("effect '{}' needs a value: --set {}={:g} ({}; between {:g} and {:g})", e.name,
                                   p.name, p.start, p.about, p.low, p.high));
    effects::require_in_bounds(fmt::format("{}={:g}", p.name, at->second), e, p, at->second);
    out.values(as_index(i)) = at->second;
  }
  return out;
}

}  // namespace deflect::diagnosis
