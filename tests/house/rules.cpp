#include "tests/house/rules.h"

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>

#include "msa/base/files.h"
#include "tests/house/confinements.h"

namespace deflect::house {
namespace {

using Rooms = std::set<std::string>;

/// Who may look into whom, from the ground up: only down. Every room may look into itself, and tests into all.
const std::vector<std::pair<std::string, Rooms>>& table() {
  static const std::vector<std::pair<std::string, Rooms>> rooms = {
      {"msa/base", {}},
      {"msa/fields", {"msa/base"}},
      {"msa/mechanism/sections", {"msa/base"}},
      {"msa/mechanism", {"msa/base", "msa/fields", "msa/mechanism/sections"}},
      {"analytic", {"msa/base", "msa/mechanism"}},
      {"msa/frame/elements", {"msa/base"}},
      {"msa/frame/structure", {"msa/base", "msa/frame/elements"}},
      {"msa/frame/deformed", {"msa/base", "msa/frame/elements", "msa/frame/structure"}},
      {"msa/frame/iterative", {"msa/base", "msa/frame/elements", "msa/frame/structure"}},
      {"msa/frame/laws", {"msa/base", "msa/mechanism", "msa/frame/elements", "msa/frame/structure"}},
      {"msa/frame/file",
       {"msa/base", "msa/fields", "msa/mechanism", "msa/frame/elements", "msa/frame/structure", "msa/frame/deformed",
        "msa/frame/iterative", "msa/frame/laws"}},
      {"msa/frame/mechanism",
       {"msa/base", "msa/mechanism", "msa/frame/elements", "msa/frame/structure", "msa/frame/deformed",
        "msa/frame/laws"}},
      {"meshes", {"msa/base", "msa/mechanism", "msa/frame/file", "msa/frame/mechanism"}},
      {"validation/json", {"msa/base"}},
      {"validation/measurement", {"msa/base", "msa/mechanism"}},
      {"validation/parallel", {"msa/base"}},
      {"validation/theories", {"msa/base", "msa/mechanism", "analytic", "msa/frame/mechanism", "meshes"}},
      {"validation/studies",
       {"msa/base", "msa/mechanism", "analytic", "msa/frame/mechanism", "meshes", "validation/measurement",
        "validation/parallel", "validation/theories"}},
      {"validation/prediction",
       {"msa/base", "msa/mechanism", "msa/frame/mechanism", "validation/measurement", "validation/parallel",
        "validation/theories", "validation/studies"}},
      {"validation/subject",
       {"msa/base", "msa/fields", "msa/mechanism", "analytic", "msa/frame/file", "validation/measurement",
        "validation/prediction"}},
      {"validation/recording", {"msa/base", "msa/frame/file", "validation/measurement"}},
      {"validation/statistics", {"msa/base", "validation/measurement", "validation/parallel", "validation/subject"}},
      {"validation/compare",
       {"msa/base", "msa/frame/file", "validation/measurement", "validation/parallel", "validation/recording",
        "validation/statistics", "validation/prediction", "validation/subject"}},
      {"validation/effects", {"msa/base", "msa/fields", "msa/mechanism", "msa/frame/file", "validation/subject"}},
      {"validation/diagnosis",
       {"msa/base", "validation/json", "msa/fields", "validation/measurement", "validation/parallel",
        "validation/statistics", "validation/compare", "validation/effects", "validation/subject"}},
      {"validation/fit",
       {"msa/base", "validation/json", "msa/fields", "msa/mechanism", "msa/frame/file", "validation/measurement",
        "validation/parallel", "validation/theories", "validation/prediction", "validation/statistics",
        "validation/compare", "validation/effects", "validation/subject", "validation/diagnosis"}},
      {"validation/validity",
       {"msa/base", "msa/frame/file", "msa/frame/mechanism", "validation/measurement", "validation/parallel",
        "validation/theories", "validation/prediction", "validation/statistics", "validation/compare",
        "validation/subject", "validation/fit"}},
      {"validation/plan",
       {"msa/base", "msa/mechanism", "validation/measurement", "validation/parallel", "validation/prediction",
        "validation/statistics", "validation/subject", "validation/compare", "validation/effects",
        "validation/diagnosis"}},
      {"validation/matrix", {"msa/base", "validation/json"}},
      {"validation/report",
       {"msa/base", "validation/json", "msa/fields", "msa/mechanism", "msa/frame/structure", "msa/frame/file",
        "validation/measurement", "validation/studies", "validation/theories", "validation/compare",
        "validation/effects", "validation/diagnosis", "validation/matrix"}},
      {"validation/report/validity",
       {"msa/base", "validation/json", "validation/measurement", "validation/theories", "validation/compare",
        "validation/subject", "validation/diagnosis", "validation/fit", "validation/validity", "validation/report"}},
      {"validation/report/plan",
       {"msa/base", "validation/json", "validation/measurement", "validation/subject", "validation/effects",
        "validation/diagnosis", "validation/plan", "validation/report"}},
      {"validation/result_files", {"msa/base", "validation/json", "validation/measurement", "validation/report"}},
      {"validation/figures",
       {"msa/base", "validation/json", "msa/mechanism", "msa/frame/structure", "msa/frame/file", "msa/frame/mechanism",
        "validation/measurement", "validation/parallel", "validation/studies", "validation/theories",
        "validation/compare", "validation/validity", "validation/plan", "validation/report",
        "validation/report/validity"}},
      {"validation/scene",
       {"msa/base", "validation/json", "msa/fields", "msa/mechanism", "msa/mechanism/sections", "msa/frame/mechanism",
        "msa/frame/file", "validation/measurement", "validation/theories", "validation/effects", "validation/report",
        "validation/figures"}},
      {"validation/page",
       {"msa/base", "validation/json", "validation/measurement", "validation/compare", "validation/report",
        "validation/result_files", "validation/figures", "validation/scene"}},
      {"validation/python",
       {"msa/base",
        "msa/fields",
        "msa/mechanism",
        "msa/frame/structure",
        "msa/frame/file",
        "meshes",
        "validation/parallel",
        "validation/studies",
        "validation/measurement",
        "validation/prediction",
        "validation/compare",
        "validation/subject",
        "validation/effects",
        "validation/diagnosis",
        "validation/fit",
        "validation/validity",
        "validation/plan",
        "validation/matrix",
        "validation/report",
        "validation/report/validity",
        "validation/report/plan",
        "validation/result_files",
        "validation/figures",
        "validation/page"}},
      {"validation/cli",
       {"msa/base",
        "validation/json",
        "msa/fields",
        "msa/mechanism",
        "analytic",
        "msa/frame/structure",
        "msa/frame/file",
        "msa/frame/mechanism",
        "meshes",
        "validation/measurement",
        "validation/parallel",
        "validation/studies",
        "validation/theories",
        "validation/compare",
        "validation/subject",
        "validation/effects",
        "validation/diagnosis",
        "validation/fit",
        "validation/validity",
        "validation/report",
        "validation/report/validity",
        "validation/result_files",
        "validation/figures",
        "validation/scene",
        "validation/page"}},
      {"validation/cli/commands",
       {"msa/base",
        "validation/json",
        "msa/fields",
        "msa/mechanism",
        "analytic",
        "msa/frame/file",
        "meshes",
        "validation/parallel",
        "validation/studies",
        "validation/theories",
        "validation/measurement",
        "validation/prediction",
        "validation/compare",
        "validation/subject",
        "validation/effects",
        "validation/diagnosis",
        "validation/fit",
        "validation/validity",
        "validation/plan",
        "validation/report",
        "validation/report/validity",
        "validation/report/plan",
        "validation/result_files",
        "validation/figures",
        "validation/scene",
        "validation/page",
        "validation/cli"}},
  };
  return rooms;
}

const Rooms* allowed_in(const std::string& room) {
  for (const auto& [name, others] : table())
    if (name == room) return &others;
  return nullptr;
}

struct Include {
  int line;
  std::string name;  ///< empty when it could not be read off
  bool quoted;
};

std::vector<Include> includes_of(const std::string& text) {
  static const std::regex directive(R"(\s*#\s*include(_next)?\b(.*))");
  static const std::regex named(R"(\s*(["<])([^">]+)[">].*)");
  std::vector<Include> found;
  std::istringstream lines(text);
  std::string line;
  std::smatch match;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.find("include") == std::string::npos || !std::regex_match(line, match, directive)) continue;
    const std::string rest = match[2];
    if (std::regex_match(rest, match, named))
      found.push_back({number, match[2], match[1] == "\""});
    else
      found.push_back({number, "", false});
  }
  return found;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> found;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) found.push_back(line);
  return found;
}

/// Of a room of validation and of the rooms in it: deflect::<room>.
std::string validation_namespace(const std::string& path) {
  static const std::regex inside("validation/([^/]+)/.*");
  std::smatch match;
  return std::regex_match(path, match, inside) ? "deflect::" + match[1].str() : "";
}

std::string list(const Rooms& rooms) {
  std::string text;
  for (const std::string& room : rooms) text += (text.empty() ? "" : ", ") + room;
  return text.empty() ? "no other room" : text;
}

/// The broken rule, or nothing.
std::string judge_own(const std::string& from, const Include& include, const std::set<std::string>& paths) {
  if (!paths.contains(include.name))
    return "there is no such file; an own header is named by its path from the root, others stand in <>";
  if (!include.quoted) return "an own header is included with quotes";
  const std::string to = room_of(include.name);
  if (from.empty() || to.empty()) return "one of the two files is in no room of the table";
  if (from == to) return "";
  if (to == "tests") return "nothing includes tests";
  if (from == "tests" && !to.empty()) return "";
  if (from == "analytic" && to.starts_with("msa/frame/"))
    return "the two theories never include each other: analytic may include " + list(*allowed_in(from));
  return allowed_in(from)->contains(to) ? "" : from + " may include " + list(*allowed_in(from));
}

}  // namespace

std::string room_of(const std::string& path) {
  if (path.starts_with("tests/")) return "tests";
  const std::size_t name = path.rfind('/');
  const std::string folder = name == std::string::npos ? "" : path.substr(0, name);
  return allowed_in(folder) ? folder : "";
}

std::vector<std::string> include_violations(const std::vector<Source>& sources) {
  std::set<std::string> paths;
  for (const Source& source : sources) paths.insert(source.path);

  std::vector<std::string> violations;
  std::map<const Confinement*, std::set<std::string>> users;
  for (const Source& source : sources) {
    const std::string from = room_of(source.path);
    for (const Include& include : includes_of(source.text)) {
      const auto refuse = [&](const std::string& rule) {
        violations.push_back(source.path + ":" + std::to_string(include.line) + ": includes " +
                             (include.name.empty() ? "a macro" : include.name) + ": " + rule);
      };
      if (include.name.empty()) {
        refuse("the file's name must stand there");
        continue;
      }
      if (include.quoted || !room_of(include.name).empty()) {
        if (const std::string rule = judge_own(from, include, paths); !rule.empty()) refuse(rule);
        continue;
      }
      for (const Confinement& c : confinements) {
        if (!std::regex_match(include.name, std::regex(c.includes))) continue;
        if (std::regex_match(source.path, std::regex(c.beside))) continue;
        users[&c].insert(source.path);
        if (!std::regex_match(source.path, std::regex(c.where)))
          refuse(std::string(c.what) + " belongs into " + c.rule);
        else if (users[&c].size() > c.files)
          refuse(std::string(c.what) + " belongs into " + c.rule + ", and " + *users[&c].begin() +
                 " includes it already");
      }
    }
  }
  return violations;
}

std::vector<std::string> table_violations() {
  std::vector<std::string> violations;
  Rooms below;
  for (const auto& [room, others] : table()) {
    for (const std::string& other : others)
      if (!below.contains(other)) violations.push_back(room + " looks up into " + other);
    below.insert(room);
  }
  return violations;
}

std::vector<std::string> namespace_violations(const std::vector<Source>& sources) {
  static const std::regex opened(R"(namespace (deflect[\w:]*) \{)");
  static const std::regex names_only(R"((class|struct) \w+;|using [\w:]+;|///? .*)");
  static const std::regex whole(R"(\s*using namespace .*)");
  std::vector<std::string> violations;
  for (const Source& source : sources) {
    if (source.path.starts_with("tests/")) continue;
    const std::string own = validation_namespace(source.path);
    const std::vector<std::string> lines = lines_of(source.text);
    bool at_home = own.empty();
    const auto refuse = [&](std::size_t line, const std::string& what) {
      violations.push_back(source.path + ":" + std::to_string(line + 1) + ": " + what);
    };
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::smatch match;
      if (source.path.ends_with(".h") && std::regex_match(lines[i], whole))
        refuse(i, "a header uses a whole namespace");
      if (own.empty() || !std::regex_match(lines[i], match, opened)) continue;
      const std::string name = match[1];
      if (name == own || name.starts_with(own + "::")) {
        at_home = true;
        continue;
      }
      std::size_t end = i + 1;
      while (end < lines.size() && std::regex_match(lines[end], names_only)) ++end;
      if (end == lines.size() || !lines[end].starts_with("}")) refuse(i, "opens " + name + ", its own is " + own);
    }
    if (!at_home) violations.push_back(source.path + ": does not open " + own);
  }
  return violations;
}

std::vector<std::string> crowded_rooms(const std::vector<Source>& sources, int limit) {
  std::map<std::string, int> count;
  for (const Source& source : sources)
    if (source.path.ends_with(".cpp") && !source.path.starts_with("tests/")) ++count[room_of(source.path)];
  std::vector<std::string> violations;
  for (const auto& [room, files] : count)
    if (files > limit) violations.push_back(room + " has " + std::to_string(files) + " sources");
  return violations;
}

std::vector<std::string> length_violations(const std::vector<Source>& sources, int limit) {
  std::vector<std::string> violations;
  for (const auto& [path, text] : sources) {
    const bool open_end = !text.empty() && text.back() != '\n';
    const auto lines = std::count(text.begin(), text.end(), '\n') + (open_end ? 1 : 0);
    if (lines > limit)
      violations.push_back(path + ": " + std::to_string(lines) + " lines, at most " + std::to_string(limit));
  }
  return violations;
}

std::vector<std::string> top_level_violations(const std::vector<std::string>& names, const std::string& gitignore) {
  static const std::set<std::string> fixed = {
      "CMakeLists.txt", "CMakePresets.json", "LICENSE", "README.md", "analytic", "meshes", "msa",
      "tests",          "validation"};
  std::vector<std::string> patterns;
  std::istringstream lines(gitignore);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('/')) line.erase(0, 1);
    if (line.ends_with('/')) line.pop_back();
    if (!line.empty()) patterns.push_back(line);
  }
  const auto ignored = [&](std::string_view name) {
    return std::any_of(patterns.begin(), patterns.end(), [&](std::string_view pattern) {
      if (!pattern.ends_with('*')) return name == pattern;
      pattern.remove_suffix(1);
      return name.starts_with(pattern);
    });
  };
  std::vector<std::string> violations;
  for (const std::string& name : names)
    if (!fixed.contains(name) && !name.starts_with('.') && !ignored(name))
      violations.push_back(name + ": does not belong to the top level");
  return violations;
}

std::vector<Source> read_sources(const std::filesystem::path& root, const std::vector<std::string>& extensions) {
  namespace fs = std::filesystem;
  std::vector<Source> sources;
  for (const char* top : {"msa", "analytic", "meshes", "validation", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string extension = entry.path().extension().string();
      if (!entry.is_regular_file() || std::find(extensions.begin(), extensions.end(), extension) == extensions.end())
        continue;
      sources.push_back({fs::relative(entry.path(), root).generic_string(), read_text(entry.path())});
    }
  std::sort(sources.begin(), sources.end(), [](const Source& a, const Source& b) { return a.path < b.path; });
  return sources;
}

}  // namespace deflect::house
