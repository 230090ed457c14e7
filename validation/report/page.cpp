#include "validation/report/page.h"

#include <fmt/format.h>

#include "msa/base/error.h"
#include "validation/report/page_residuals.h"
#include "validation/report/page_template.h"

namespace deflect {
namespace {

constexpr std::size_t most_source = 600'000;  // bytes
constexpr std::size_t most_readings = 3000;   // of all versions
constexpr const char* data_mark = "@DEFLECT_DATA@";

/// Which command wrote a result, by the members that only its results have.
const char* kind_of(const Json& result) {
  struct Kind {
    const char *name, *members[2];
  };
  constexpr Kind kinds[] = {{"diagnosis", {"verdict", "candidates"}},
                            {"comparison", {"findings", "tests"}},
                            {"history", {"versions", "data"}},
                            {"validation", {"points", "max_relative_difference"}},
                            {"map", {"grid", "arrays"}},
                            {"drawing", {"drawing", "lines"}},
                            {"solve", {"analytic", "shares"}}};
  for (const Kind& kind : kinds)
    if (result.is_object() && result.contains(kind.members[0]) && result.contains(kind.members[1])) return kind.name;
  return nullptr;
}

/// Matrices pose by pose would make a page of many megabytes: ranged columns stay.
void keep_what_is_shown(Json& map) {
  for (const char* theory : {"analytic", "msa"}) {
    if (!map["arrays"].contains(theory)) continue;
    Json kept = Json::object();
    for (const auto& [name, values] : map["arrays"][theory].items())
      if (name.starts_with("stiffness") || name.starts_with("smallest") || name.starts_with("largest") ||
          name == "isotropy")
        kept[name] = values;
    map["arrays"][theory] = std::move(kept);
  }
}

Json parsed(const PageResult& result) {
  Json json;
  try {
    json = Json::parse(result.json);
  } catch (const Json::exception& e) {
    throw InputError(fmt::format("{}: not valid JSON: give files that --json wrote", result.origin));
  }
  const char* kind = kind_of(json);
  if (!kind)
    throw InputError(
        fmt::format("{}: not a result of diagnose, compare, history, solve, validate, map or show: give files that "
                    "their --json wrote",
                    result.origin));
  if (kind == std::string_view("map")) keep_what_is_shown(json);
  return {{"kind", kind}, {"origin", result.origin}, {"result", std::move(json)}};
}

Json source_json(const std::optional<PageSource>& source) {
  if (!source) return nullptr;
  const bool held = source->text.size() <= most_source;
  return {{"name", source->name}, {"bytes", source->text.size()}, {"text", held ? Json(source->text) : Json()}};
}

/// What a script element may hold: no "<", so that no text ends it or begins a comment; bytes that are no UTF-8 are
/// replaced.
std::string embedded(const Json& data) {
  std::string out;
  for (const char c : data.dump(-1, ' ', false, Json::error_handler_t::replace))
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  return out;
}

}  // namespace

bool pages_are_built() { return !page_template().empty(); }

Json page_json(const PageContents& page) {
  Json data;
  data["version"] = page.version;
  data["made_with"] = fmt::format("g++ {}.{}, Eigen {}.{}.{}", __GNUC__, __GNUC_MINOR__, EIGEN_WORLD_VERSION,
                                  EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
  data["command"] = page.command;
  data["device"] = source_json(page.device);
  data["data"] = source_json(page.data);
  data["results"] = Json::array();
  for (const PageResult& result : page.results) data["results"].push_back(parsed(result));
  data["versions"] = Json::array();
  for (const Comparison* c : page.versions)
    data["versions"].push_back(residuals_json(*c, most_readings / page.versions.size()));
  data["scene"] = page.scene;
  return data;
}

std::string page_html(const PageContents& page) {
  const std::string_view whole = page_template();
  const std::size_t at = whole.find(data_mark);
  if (at == whole.npos)
    throw InputError(
        "this deflect was built without pages: install esbuild, libjs-three and libjs-chart.js, configure and build "
        "again");
  std::string out(whole.substr(0, at));
  out += embedded(page_json(page));
  return out.append(whole.substr(at + std::string_view(data_mark).size()));
}

}  // namespace deflect
