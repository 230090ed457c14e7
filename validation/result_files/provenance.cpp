#include "validation/result_files/provenance.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/outcome.h"
#include "validation/measurement/column_names.h"

namespace deflect::result_files {
namespace {

constexpr const char* provenance_key = "provenance";
constexpr double rounding = 1e-13;

Json files_json(const std::vector<HashedFile>& files) {
  Json out = Json::array();
  for (const HashedFile& f : files)
    out.push_back({{"name", f.name}, {"sha256", f.sha256.empty() ? Json() : Json(f.sha256)}});
  return out;
}

/// A member of the provenance; InputError where it is not of the type.
const Json& wanted(const Json& in, const char* name, bool (Json::*is)() const noexcept, const std::string& origin) {
  if (!in.is_object() || !in.contains(name) || !(in[name].*is)())
    throw InputError(fmt::format("{}: {}.{} is missing or not as the program writes it: make the result again", origin,
                                 provenance_key, name));
  return in[name];
}

std::vector<HashedFile> read_files(const Json& list, const char* name, const std::string& origin) {
  std::vector<HashedFile> out;
  for (const Json& each : list) {
    const std::string file = wanted(each, "name", &Json::is_string, origin);
    if (!each.contains("sha256") || !(each["sha256"].is_string() || each["sha256"].is_null()))
      throw InputError(
          fmt::format("{}: {}.{}: '{}' has no hash: make the result again", origin, provenance_key, name, file));
    out.push_back({file, each["sha256"].is_null() ? "" : each["sha256"].get<std::string>()});
  }
  return out;
}

/// Walks two results side by side.
class Comparison {
 public:
  Comparison(double tolerance, std::size_t most) : tolerance_(tolerance), most_(most) {}

  void walk(const Json& before, const Json& now, const std::string& path, double largest) {
    if (out.size() >= most_) return;
    if (before.is_number() && now.is_number()) {
      if (!same(before, now, largest)) tell(path, before, now);
    } else if (before.is_object() && now.is_object()) {
      walk_objects(before, now, path);
    } else if (before.is_array() && now.is_array()) {
      walk_lists(before, now, path);
    } else if (before != now) {
      tell(path, before, now);
    }
  }

  std::vector<std::string> out;

 private:
  bool same(const Json& before, const Json& now, double largest) const {
    if (before == now) return true;
    const auto a = before.get<double>(), b = now.get<double>();
    return std::abs(a - b) <= std::max(tolerance_ * std::max(std::abs(a), std::abs(b)), rounding * largest);
  }

  void walk_objects(const Json& before, const Json& now, const std::string& path) {
    for (const auto& [name, value] : before.items()) {
      if (path.empty() && name == provenance_key) continue;
      const std::string at = path.empty() ? name : path + "." + name;
      if (now.contains(name))
        walk(value, now[name], at, 0);
      else if (out.size() < most_)
        out.push_back(at + ": is no more there");
    }
    for (const auto& [name, value] : now.items())
      if (!before.contains(name) && out.size() < most_ && !(path.empty() && name == provenance_key))
        out.push_back(fmt::format("{}: was not there", path.empty() ? name : path + "." + name));
  }

  void walk_lists(const Json& before, const Json& now, const std::string& path) {
    if (before.size() != now.size()) {
      out.push_back(fmt::format("{}: {} entries instead of {}", path, now.size(), before.size()));
      return;
    }
    double largest = 0;
    for (const Json* list : {&before, &now})
      for (const Json& each : *list)
        if (each.is_number()) largest = std::max(largest, std::abs(each.get<double>()));
    for (std::size_t i = 0; i < before.size(); ++i) walk(before[i], now[i], fmt::format("{}[{}]", path, i), largest);
  }

  void tell(const std::string& path, const Json& before, const Json& now) {
    const auto words = [](const Json& value) {
      return value.is_number() ? value.dump() : measurement::excerpt(json::compact(value));
    };
    out.push_back(fmt::format("{}: {} instead of {}", path, words(now), words(before)));
  }

  double tolerance_;
  std::size_t most_;
};

/// "model name : …" of the first processor; empty where the system does not tell.
std::string processor_name() {
  const auto text = outcome_of<InputError>([] { return read_text("/proc/cpuinfo"); });
  if (!text) return "";
  const std::string key = "model name";
  const std::size_t at = text->find(key), colon = at == text->npos ? at : text->find(':', at);
  if (colon == text->npos) return "";
  const std::size_t from = text->find_first_not_of(" \t", colon + 1), to = text->find('\n', colon);
  return from < to ? text->substr(from, to - from) : "";
}

}  // namespace

Json provenance_json(const Provenance& p) {
  Json out = {{"program", p.program}, {"command", p.command}, {"inputs", files_json(p.inputs)}};
  if (!p.outputs.empty()) out["outputs"] = files_json(p.outputs);
  if (p.seed) out["seed"] = *p.seed;
  out["machine"] = {{"system", p.system}, {"processor", p.processor}, {"compiler", p.compiler}};
  return out;
}

std::string with_provenance(const std::string& result, const Provenance& p) {
  // Not parsed: a map may have millions of numbers. Its end is that of every object of several lines.
  constexpr std::string_view end = "\n}\n";
  std::string text = json::json_text(Json{{provenance_key, provenance_json(p)}});
  return result.substr(0, result.size() - end.size()) + "," + text.substr(1);
}

Provenance read_provenance(const Json& result, const std::string& origin) {
  if (!result.is_object() || !result.contains(provenance_key))
    throw InputError(fmt::format("{}: there is no member '{}': give a result that --json of this version wrote", origin,
                                 provenance_key));
  const Json& of = result[provenance_key];
  Provenance p;
  p.program = wanted(of, "program", &Json::is_string, origin);
  for (const Json& word : wanted(of, "command", &Json::is_array, origin)) {
    if (!word.is_string())
      throw InputError(fmt::format("{}: {}.command holds {}", origin, provenance_key, json::compact(word)));
    p.command.push_back(word);
  }
  if (p.command.empty()) throw InputError(fmt::format("{}: {}.command is empty", origin, provenance_key));
  p.inputs = read_files(wanted(of, "inputs", &Json::is_array, origin), "inputs", origin);
  if (of.contains("outputs")) p.outputs = read_files(wanted(of, "outputs", &Json::is_array, origin), "outputs", origin);
  const Json& machine = wanted(of, "machine", &Json::is_object, origin);
  p.system = wanted(machine, "system", &Json::is_string, origin);
  p.processor = wanted(machine, "processor", &Json::is_string, origin);
  p.compiler = wanted(machine, "compiler", &Json::is_string, origin);
  return p;
}

void describe_machine(Provenance& p) {
  struct utsname names {};
  if (::uname(&names) == 0) p.system = fmt::format("{} {}", names.sysname, names.machine);
  p.processor = processor_name();
#ifdef __clang__
  p.compiler = "clang++ " __clang_version__;
#else
  p.compiler = "g++ " __VERSION__;
#endif
}

std::vector<std::string> differences(const Json& before, const Json& now, double tolerance, std::size_t most) {
  Comparison c(tolerance, most);
  c.walk(before, now, "", 0);
  return std::move(c.out);
}

}  // namespace deflect::result_files
