#include "validation/report/result_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <vector>

#include "msa/base/error.h"
#include "validation/measurement/column_names.h"

namespace deflect {
namespace {

constexpr int deepest = 32;  // lists and objects in each other: results have six

/// A member by its path, "candidates[].site", "cases{}.energy_Nmm" of an object with names of its own, and what it must
/// be: text, number, number or null (an infinite one is written so), truth, list, object; three, six, 6×6 numbers.
struct WantedMember {
  const char* path;
  enum class Type { text, number, number_or_null, truth, list, object, three, six, six_by_six } type;
};
using Type = WantedMember::Type;

constexpr const char* type_names[] = {"a text",    "a number",      "a number",    "true or false",          "a list",
                                      "an object", "three numbers", "six numbers", "six rows of six numbers"};

struct ResultKind {
  const char* name;
  const char* members[2];  ///< by which it is known where it does not say its kind
  std::vector<WantedMember> wanted;
};

const std::vector<ResultKind>& result_kinds() {
  static const std::vector<ResultKind> all = {{"diagnosis",
                                               {"verdict", "candidates"},
                                               {{"verdict", Type::text},
                                                {"missing", Type::list},
                                                {"missing[]", Type::text},
                                                {"candidates", Type::list},
                                                {"candidates[].effect", Type::text},
                                                {"candidates[].site", Type::text},
                                                {"candidates[].probability", Type::number},
                                                {"candidates[].rmse_mm", Type::number},
                                                {"candidates[].held_out_rmse_mm", Type::number},
                                                {"candidates[].chi2_per_dof", Type::number},
                                                {"candidates[].parameters", Type::list},
                                                {"candidates[].parameters[].name", Type::text},
                                                {"candidates[].parameters[].value", Type::number_or_null},
                                                {"candidates[].parameters[].low95", Type::number_or_null},
                                                {"candidates[].parameters[].high95", Type::number_or_null},
                                                {"indistinguishable", Type::list},
                                                {"indistinguishable[]", Type::list},
                                                {"indistinguishable[][]", Type::text},
                                                {"baseline.rmse_mm", Type::number},
                                                {"baseline.held_out_rmse_mm", Type::number},
                                                {"baseline.chi2_per_dof", Type::number},
                                                {"final.rmse_mm", Type::number},
                                                {"final.held_out_rmse_mm", Type::number},
                                                {"final.chi2_per_dof", Type::number},
                                                {"noise_floor_mm", Type::number},
                                                {"unexplained.significant", Type::truth},
                                                {"unexplained.share_of_misfit", Type::number},
                                                {"unexplained.pattern", Type::text},
                                                {"found?", Type::list},
                                                {"found?[].effect", Type::text},
                                                {"found?[].site", Type::text},
                                                {"found?[].parameters", Type::list},
                                                {"found?[].parameters[].name", Type::text},
                                                {"found?[].parameters[].value", Type::number},
                                                {"device?", Type::text},
                                                {"sentence?", Type::text},
                                                {"headline?", Type::text},
                                                {"candidates[].title?", Type::text},
                                                {"found?[].title?", Type::text},
                                                {"detectable?", Type::list},
                                                {"detectable?[].effect", Type::text},
                                                {"detectable?[].site", Type::text},
                                                {"detectable?[].smallest", Type::list},
                                                {"detectable?[].cosine", Type::number},
                                                {"strained_tolerances?", Type::list},
                                                {"strained_tolerances?[].name", Type::text},
                                                {"strained_tolerances?[].sigmas", Type::number},
                                                {"probability_nothing?", Type::number},
                                                {"probability_unknown?", Type::number}}},
                                              {"comparison",
                                               {"findings", "tests"},
                                               {{"device", Type::text},
                                                {"verdict", Type::text},
                                                {"findings", Type::list},
                                                {"findings[].pattern", Type::text},
                                                {"findings[].sentence", Type::text},
                                                {"findings[].size_mm", Type::number},
                                                {"findings[].share_of_misfit", Type::number},
                                                {"findings[].p_value", Type::number},
                                                {"findings[].instead", Type::list},
                                                {"tests", Type::list},
                                                {"tests[].test", Type::text},
                                                {"tests[].question", Type::text},
                                                {"patterns", Type::list},
                                                {"patterns[].pattern", Type::text},
                                                {"patterns[].title", Type::text},
                                                {"patterns[].size_mm", Type::number},
                                                {"patterns[].p_value", Type::number},
                                                {"errors", Type::object},
                                                {"baseline.rmse_mm", Type::number},
                                                {"baseline.chi2_per_dof", Type::number},
                                                {"noise_floor_mm", Type::number},
                                                {"looks_like", Type::list},
                                                {"looks_like[]", Type::text}}},
                                              {"history",
                                               {"versions", "data"},
                                               {{"versions", Type::list},
                                                {"versions[].device", Type::text},
                                                {"versions[].rmse_mm", Type::number},
                                                {"versions[].placebo_rmse_mm", Type::number_or_null},
                                                {"versions[].held_out_rmse_mm", Type::number},
                                                {"versions[].chi2_per_dof", Type::number},
                                                {"versions[].noise_floor_mm", Type::number},
                                                {"versions[].failing_tests", Type::list},
                                                {"versions[].patterns", Type::list},
                                                {"versions[].strained_tolerances", Type::list}}},
                                              {"validation",
                                               {"points", "max_relative_difference"},
                                               {{"points", Type::list},
                                                {"points[].pose", Type::six},
                                                {"points[].load_axis", Type::text},
                                                {"points[].load_N", Type::number},
                                                {"points[].analytic", Type::six},
                                                {"points[].msa", Type::six},
                                                {"max_relative_difference", Type::number},
                                                {"rms_relative_difference", Type::number}}},
                                              {"map",
                                               {"grid", "arrays"},
                                               {{"grid.x_mm", Type::list},
                                                {"grid.y_mm", Type::list},
                                                {"grid.z_mm", Type::list},
                                                {"grid.x_mm[]", Type::number},
                                                {"grid.y_mm[]", Type::number},
                                                {"grid.z_mm[]", Type::number},
                                                {"arrays", Type::object},
                                                {"reached", Type::number},
                                                {"poses", Type::number}}},
                                              {"drawing",
                                               {"drawing", "lines"},
                                               {{"name", Type::text},
                                                {"about", Type::text},
                                                {"driven", Type::list},
                                                {"driven[].name", Type::text},
                                                {"driven[].value", Type::number},
                                                {"members", Type::list},
                                                {"members[].start_mm", Type::three},
                                                {"members[].end_mm", Type::three},
                                                {"members[].length_mm", Type::number},
                                                {"members[].axes", Type::list},
                                                {"members[].axes[]", Type::three},
                                                {"joints", Type::list},
                                                {"joints[].at_mm", Type::three},
                                                {"joints[].axes", Type::list},
                                                {"joints[].axes[]", Type::three},
                                                {"joints[].freedoms", Type::text},
                                                {"frames", Type::list},
                                                {"frames[].at_mm", Type::three},
                                                {"frames[].axes", Type::list},
                                                {"frames[].axes[]", Type::three},
                                                {"points_mm", Type::list},
                                                {"points_mm[]", Type::three},
                                                {"lines", Type::list},
                                                {"lines[]", Type::three},
                                                {"motions", Type::list},
                                                {"motions[].words", Type::text},
                                                {"motions[].displacement_mm", Type::list},
                                                {"motions[].displacement_mm[]", Type::three}}},
                                              {"check",
                                               {"checks", "passes"},
                                               {{"file", Type::text},
                                                {"verdict", Type::text},
                                                {"passes", Type::truth},
                                                {"matrix", Type::six_by_six},
                                                {"checks", Type::list},
                                                {"checks[].check", Type::text},
                                                {"checks[].quantity", Type::text},
                                                {"checks[].measured?", Type::number},
                                                {"checks[].at_least?", Type::number},
                                                {"checks[].at_most?", Type::number},
                                                {"checks[].passes", Type::truth},
                                                {"diagnosis", Type::list},
                                                {"diagnosis[].sentence", Type::text},
                                                {"diagnosis[].remedy", Type::text},
                                                {"eigenvalues_N_per_mm", Type::six},
                                                {"weighing_length_mm", Type::number},
                                                {"centre_of_stiffness_mm?", Type::three},
                                                {"centre_of_compliance_mm?", Type::three},
                                                {"principal_translation_N_per_mm?", Type::three},
                                                {"principal_axes?", Type::list},
                                                {"principal_axes?[]", Type::three},
                                                {"principal_rotation_Nmm_per_rad?", Type::three}}},
                                              {"frame",
                                               {"frame", "cases"},
                                               {{"frame", Type::text},
                                                {"geometry", Type::text},
                                                {"notes", Type::list},
                                                {"notes[]", Type::text},
                                                {"cases", Type::object},
                                                {"cases{}.displacements", Type::list},
                                                {"cases{}.displacements[].node", Type::text},
                                                {"cases{}.displacements[].ux_mm", Type::number},
                                                {"cases{}.displacements[].uy_mm", Type::number},
                                                {"cases{}.displacements[].uz_mm", Type::number},
                                                {"cases{}.displacements[].rx_rad", Type::number},
                                                {"cases{}.displacements[].ry_rad", Type::number},
                                                {"cases{}.displacements[].rz_rad", Type::number},
                                                {"cases{}.reactions", Type::list},
                                                {"cases{}.reactions[].node", Type::text},
                                                {"cases{}.members", Type::list},
                                                {"cases{}.members[].member", Type::text},
                                                {"cases{}.members[].start.N_N", Type::number},
                                                {"cases{}.members[].end.N_N", Type::number},
                                                {"cases{}.members[].largest_My_Nmm", Type::number},
                                                {"cases{}.members[].largest_Mz_Nmm", Type::number},
                                                {"cases{}.energy_Nmm", Type::number},
                                                {"cases{}.shares", Type::list},
                                                {"cases{}.shares[].part", Type::text},
                                                {"cases{}.shares[].share", Type::number},
                                                {"cases{}.checks", Type::object}}},
                                              {"solve",
                                               {"analytic", "shares"},
                                               {{"load", Type::six},
                                                {"analytic.displacement", Type::six},
                                                {"analytic.stiffness", Type::six_by_six},
                                                {"msa.displacement", Type::six},
                                                {"msa.stiffness", Type::six_by_six},
                                                {"relative_difference", Type::number},
                                                {"shares", Type::list},
                                                {"shares[].part", Type::text},
                                                {"shares[].share", Type::number}}}};
  return all;
}

bool is_list_of(std::size_t size, const Json& value, bool (*each)(const Json&)) {
  return value.is_array() && value.size() == size && std::all_of(value.begin(), value.end(), each);
}

bool is_number(const Json& value) { return value.is_number(); }

bool has_type(const Json& value, Type type) {
  switch (type) {
    case Type::text:
      return value.is_string();
    case Type::number:
      return value.is_number();
    case Type::number_or_null:
      return value.is_number() || value.is_null();
    case Type::truth:
      return value.is_boolean();
    case Type::list:
      return value.is_array();
    case Type::object:
      return value.is_object();
    case Type::three:
      return is_list_of(3, value, is_number);
    case Type::six:
      return is_list_of(6, value, is_number);
    case Type::six_by_six:
      return is_list_of(6, value, [](const Json& row) { return is_list_of(6, row, is_number); });
  }
  return false;
}

/// What there is instead, in the words of a person.
std::string words_of(const Json& value) {
  if (value.is_null()) return "null";
  if (value.is_array()) return fmt::format("a list of {}", value.size());
  if (value.is_object()) return "an object";
  return excerpt(value.dump(-1, ' ', false, Json::error_handler_t::replace));
}

class ResultCheck {
 public:
  ResultCheck(const std::string& origin, const char* kind) : origin_(origin), kind_(kind) {}

  void check(const Json& root, const WantedMember& wanted) const { walk(root, wanted.path, "", wanted); }

 private:
  void walk(const Json& value, std::string_view rest, const std::string& where, const WantedMember& wanted) const {
    if (rest.empty()) {
      if (!has_type(value, wanted.type))
        throw InputError(fmt::format("{}: member '{}' is {}, where {} is wanted: give the file as --json wrote it{}",
                                     origin_, where, words_of(value), type_names[static_cast<int>(wanted.type)],
                                     as_kind()));
      return;
    }
    if (rest.starts_with("[]")) {
      if (!value.is_array()) return;  // told where the list itself is wanted
      for (std::size_t i = 0; i < value.size(); ++i)
        walk(value[i], rest.substr(2), fmt::format("{}[{}]", where, i), wanted);
      return;
    }
    if (rest.starts_with("{}")) {
      if (!value.is_object()) return;
      for (const auto& [name, member] : value.items()) walk(member, rest.substr(2), where + "." + name, wanted);
      return;
    }
    if (rest.starts_with('.')) rest.remove_prefix(1);
    const std::size_t end = std::min(rest.find_first_of(".[{"), rest.size());
    std::string name(rest.substr(0, end));
    const bool may_lack = name.ends_with('?');
    if (may_lack) name.pop_back();
    const std::string path = where.empty() ? name : where + "." + name;
    if (!value.is_object() || !value.contains(name)) {
      if (may_lack) return;
      throw InputError(
          fmt::format("{}: there is no member '{}': give the file as --json wrote it{}", origin_, path, as_kind()));
    }
    walk(value[name], rest.substr(end), path, wanted);
  }

  std::string as_kind() const { return fmt::format(" (it looks like a {})", kind_); }

  const std::string& origin_;
  const char* kind_;
};

std::size_t line_at(const std::string& text, std::size_t byte) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size()));
  return 1 + static_cast<std::size_t>(std::count(text.begin(), end, '\n'));
}

/// The JSON of the text; too deep a nesting is refused before the parser follows it.
Json parsed(const std::string& text, const std::string& origin) {
  if (text.find_first_not_of(" \t\r\n") == text.npos) throw InputError(fmt::format("{}:1: the file is empty", origin));
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (quoted && text[i] == '\\')
      ++i;
    else if (text[i] == '"')
      quoted = !quoted;
    else if (!quoted && (text[i] == '[' || text[i] == '{')) {
      if (++depth > deepest)
        throw InputError(fmt::format("{}:{}: nested more than {} deep: give a file that --json wrote", origin,
                                     line_at(text, i), deepest));
    } else if (!quoted && (text[i] == ']' || text[i] == '}'))
      --depth;
  }
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& e) {
    throw InputError(fmt::format("{}:{}: not valid JSON: give a file that --json wrote, whole", origin,
                                 line_at(text, e.byte > 0 ? e.byte - 1 : 0)));
  } catch (const Json::exception&) {
    throw InputError(
        fmt::format("{}: a number is beyond what a double holds: give the file as --json wrote it", origin));
  }
}

bool is_of(const ResultKind& kind, const Json& json) {
  if (!json.is_object()) return false;
  if (json.contains("kind")) return json["kind"] == kind.name;
  return json.contains(kind.members[0]) && json.contains(kind.members[1]);
}

}  // namespace

ReadResult read_result(const std::string& text, const std::string& origin) {
  Json json = parsed(text, origin);
  for (const ResultKind& kind : result_kinds()) {
    if (!is_of(kind, json)) continue;
    for (const WantedMember& wanted : kind.wanted) ResultCheck(origin, kind.name).check(json, wanted);
    return {kind.name, std::move(json)};
  }
  throw InputError(
      fmt::format("{}: not a result of diagnose, compare, history, solve, validate, map, frame, check or show: give "
                  "files that their "
                  "--json wrote",
                  origin));
}

}  // namespace deflect
