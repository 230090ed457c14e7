#include "validation/page/page.h"

#include <fmt/format.h>

#include <algorithm>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "validation/page/page_residuals.h"
#include "validation/page/page_template.h"
#include "validation/result_files/result_file.h"

namespace deflect::page {
namespace {

constexpr std::size_t most_source = 600'000;   // bytes
constexpr std::size_t most_readings = 3000;    // of all versions
constexpr std::size_t most_frame_rows = 4000;  // of each list, in all load cases together
constexpr const char* data_mark = "@DEFLECT_DATA@";

/// Matrices pose by pose would make a page of many megabytes: ranged columns stay.
void keep_what_is_shown(Json& map) {
  for (auto& [theory, arrays] : map["arrays"].items()) {
    if (!arrays.is_object()) continue;
    Json kept = Json::object();
    for (const auto& [name, values] : arrays.items())
      if (name.starts_with("stiffness") || name.starts_with("smallest") || name.starts_with("largest") ||
          name == "isotropy")
        kept[name] = values;
    arrays = std::move(kept);
  }
}

/// Of a large frame the first rows of each list stay; "left_out" says of each list how many do not.
void keep_first_rows(Json& frame) {
  if (frame["cases"].empty()) return;
  const std::size_t most = std::max<std::size_t>(1, most_frame_rows / frame["cases"].size());
  for (auto& [name, of_case] : frame["cases"].items())
    for (const char* list : {"displacements", "reactions", "springs", "constraints", "members", "shares"}) {
      if (!of_case.contains(list) || of_case[list].size() <= most) continue;
      of_case["left_out"][list] = of_case[list].size() - most;
      of_case[list].erase(of_case[list].begin() + as_index(most), of_case[list].end());
    }
}

Json shown_result(const PageResult& result) {
  result_files::ReadResult read = result_files::read_result(result.json, result.origin);
  if (read.kind == "map") keep_what_is_shown(read.json);
  if (read.kind == "frame") keep_first_rows(read.json);
  return {{"kind", read.kind}, {"origin", result.origin}, {"result", std::move(read.json)}};
}

Json source_json(const std::optional<PageSource>& source) {
  if (!source) return nullptr;
  const bool held = source->text.size() <= most_source;
  return {{"name", source->name}, {"bytes", source->text.size()}, {"text", held ? Json(source->text) : Json()}};
}

/// What a script element may hold: no "<", so that no text ends it or begins a comment.
std::string embedded(const Json& data) {
  std::string out;
  for (const char c : json::compact(data))
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
  for (const PageResult& result : page.results) data["results"].push_back(shown_result(result));
  data["versions"] = Json::array();
  for (const compare::Comparison* c : page.versions)
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

}  // namespace deflect::page
