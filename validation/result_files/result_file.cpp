#include "validation/result_files/result_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <vector>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "validation/measurement/column_names.h"
#include "validation/result_files/result_kinds.h"

namespace deflect::result_files {
namespace {

using Type = WantedMember::Type;

constexpr const char* type_names[] = {"a text",    "a number",      "a number",    "true or false",          "a list",
                                      "an object", "three numbers", "six numbers", "six rows of six numbers"};

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
  return measurement::excerpt(json::compact(value));
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
                                     origin_, where, words_of(value), nth(type_names, wanted.type), as_kind()));
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

bool is_of(const ResultKind& kind, const Json& json) {
  if (!json.is_object()) return false;
  if (json.contains("kind")) return json["kind"] == kind.name;
  return json.contains(kind.members[0]) && json.contains(kind.members[1]);
}

/// Results of several theories say which; those of earlier versions of the program hold the closed form and the MSA.
void complete_theories(const std::string& kind, Json& json) {
  if (json.contains("theories") || (kind != "validation" && kind != "map" && kind != "solve")) return;
  json["theories"] = Json::array();
  const Json& held = kind == "map" ? json["arrays"] : kind == "solve" ? json : Json{{"analytic", 0}, {"msa", 0}};
  for (const auto& [name, title, spoken] :
       {std::tuple{"analytic", "analytic", "the analytic theory"}, std::tuple{"msa", "MSA", "the MSA"}})
    if (held.contains(name)) json["theories"].push_back({{"name", name}, {"title", title}, {"spoken", spoken}});
  if (kind == "solve") json["reference"] = "msa";
}

/// "@" in a path is each theory of the result.
std::vector<WantedMember> for_each_theory(const WantedMember& wanted, const Json& json,
                                          std::vector<std::string>& paths) {
  const std::string path = wanted.path;
  const std::size_t at = path.find('@');
  if (at == path.npos) return {wanted};
  paths.clear();
  for (const Json& theory : json["theories"])
    paths.push_back(path.substr(0, at) + theory["name"].get<std::string>() + path.substr(at + 1));
  std::vector<WantedMember> out;
  for (const std::string& each : paths) out.push_back({each.c_str(), wanted.type});
  return out;
}

}  // namespace

ReadResult read_result(const std::string& text, const std::string& origin) {
  Json json = json::parse_json(text, origin, "give a file that --json wrote, whole");
  for (const ResultKind& kind : result_kinds()) {
    if (!is_of(kind, json)) continue;
    complete_theories(kind.name, json);
    const ResultCheck check(origin, kind.name);
    if (json.contains("theories"))
      for (const WantedMember& wanted : std::vector<WantedMember>{{"theories", Type::list},
                                                                  {"theories[].name", Type::text},
                                                                  {"theories[].title", Type::text},
                                                                  {"theories[].spoken", Type::text}})
        check.check(json, wanted);
    std::vector<std::string> paths;
    for (const WantedMember& wanted : kind.wanted)
      for (const WantedMember& each : for_each_theory(wanted, json, paths)) check.check(json, each);
    return {kind.name, std::move(json)};
  }
  const bool told = json.is_object() && json.contains("kind") && json["kind"].is_string();
  throw InputError(fmt::format("{}: {}; pages are made of results of {}: give files that their --json wrote", origin,
                               told ? fmt::format("a result of the kind '{}' has no page", std::string(json["kind"]))
                                    : "not a result of a command that has a page",
                               commands_with_pages));
}

}  // namespace deflect::result_files
