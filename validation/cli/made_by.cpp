#include "validation/cli/made_by.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "validation/cli/completion.h"
#include "validation/cli/devices.h"
#include "validation/cli/talk.h"
#include "validation/result_files/sha256.h"

namespace deflect::cli {
namespace {

namespace fs = std::filesystem;

const Command* running = nullptr;

constexpr std::array<std::string_view, 5> outputs = {"--json", "--out", "-o,--output", "--report", "--resume"};
constexpr const char* catalogue = "effects/catalogue";

bool is_output(const Option& o) { return std::find(outputs.begin(), outputs.end(), o.flags) != outputs.end(); }

/// Whether the result is the same with and without it. A flag --force allows to overwrite; with a number it is a load.
bool changes_nothing(const Option& o) {
  return o.flags == "--threads" || (o.flags == "--force" && std::holds_alternative<bool*>(o.target));
}

/// The option's values as text; none where it is not in force.
std::vector<std::string> values_of(const Option& o) {
  if (const auto* text = std::get_if<std::string*>(&o.target))
    return (*text)->empty() ? std::vector<std::string>() : std::vector<std::string>{**text};
  if (const auto* number = std::get_if<double*>(&o.target))
    return std::isfinite(**number) ? std::vector<std::string>{fmt::format("{}", **number)} : std::vector<std::string>();
  if (const auto* list = std::get_if<std::vector<std::string>*>(&o.target)) return **list;
  return {};
}

/// "--output" of "-o,--output".
std::string long_flag(const Option& o) {
  const std::size_t comma = o.flags.rfind(',');
  return comma == o.flags.npos ? o.flags : o.flags.substr(comma + 1);
}

bool is_positional(const Option& o) { return o.flags.front() != '-'; }

bool is_built_in(const std::string& name) {
  for (const auto& names : {device_names(), frame_names()})
    if (std::find(names.begin(), names.end(), name) != names.end()) return true;
  return false;
}

/// All files of the catalogue, by name, each with its name.
std::string catalogue_text() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(data_folder() / catalogue))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::string out;
  for (const fs::path& file : files) out += file.filename().string() + "\n" + read_text(file);
  return out;
}

bool names_files(const Option& o) { return choices_of(o.value).files || o.value == "MACHINE"; }

/// Not of devices such as /dev/stdout, which take one after the other.
bool are_one_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  const bool there = fs::exists(a, error), also = fs::exists(b, error);
  if (there != also) return false;
  if (there) return fs::is_regular_file(a, error) && fs::equivalent(a, b, error);
  return fs::weakly_canonical(fs::absolute(a), error) == fs::weakly_canonical(fs::absolute(b), error);
}

std::vector<result_files::HashedFile> inputs_of(const Command& command) {
  std::vector<result_files::HashedFile> out;
  bool knows_effects = false;
  for (const Option& o : command.options) {
    knows_effects = knows_effects || o.flags == "--effects";
    if (is_output(o) || !names_files(o)) continue;
    for (const std::string& name : values_of(o)) {
      std::error_code error;
      if (is_built_in(name) || fs::exists(name, error)) out.push_back({name, hash_of(name)});
    }
  }
  if (knows_effects) out.push_back({catalogue, hash_of(catalogue)});
  return out;
}

/// The member of a result; null where it has none.
Json member(const Json& result, const char* where) {
  const Json::json_pointer at(where);
  return result.contains(at) ? result.at(at) : Json();
}

/// Files with their hashes as a result has them; none where it has none.
std::vector<result_files::HashedFile> files_in(const Json& result, const char* where) {
  std::vector<result_files::HashedFile> out;
  for (const auto& each : member(result, where)) {
    if (!each.is_object()) continue;
    const auto name = each.find("name"), hash = each.find("sha256");
    if (name != each.end() && name->is_string() && hash != each.end() && hash->is_string())
      out.push_back({*name, *hash});
  }
  return out;
}

result_files::Provenance provenance_of(const Command& command) {
  result_files::Provenance p;
  p.program = fmt::format("deflect {}", DEFLECT_VERSION);
  p.command = words_of(command);
  p.inputs = inputs_of(command);
  if (const Option* o = required_output(command))
    for (const std::string& name : values_of(*o)) p.outputs.push_back({name, hash_of(name)});
  for (const Option& o : command.options)
    if (o.flags == "--seed") p.seed = static_cast<std::uint64_t>(*std::get<double*>(o.target));
  result_files::describe_machine(p);
  return p;
}

}  // namespace

void set_command(const Command& command) { running = &command; }

void require_separate_files(const Command& command) {
  struct Named {
    std::string flag, file;
  };
  std::vector<Named> read, written;
  bool can_force = false, forced = false;
  for (const Option& o : command.options) {
    const auto* flag = std::get_if<bool*>(&o.target);
    if (flag && o.flags == "--force") can_force = true, forced = **flag;
    if (o.flags == "--out" || !(is_output(o) || names_files(o))) continue;
    const std::string called = o.flags.substr(0, o.flags.find(','));
    for (const std::string& file : values_of(o)) {
      if (is_output(o)) {
        if (o.flags == "-o,--output" && is_built_in(file))
          throw InputError(
              fmt::format("-o {0}: commands would read the built-in {0} by this name, and not the new file: "
                          "write {0}.yaml, or another name",
                          file));
        written.push_back({called, file});
        continue;
      }
      const std::string own = is_built_in(file) ? subject_file(file).string() : file;
      std::error_code error;  // not the name of a campaign or a case
      if (fs::exists(own, error)) read.push_back({called, own});
    }
  }
  for (std::size_t i = 0; i < written.size(); ++i) {
    const auto& [flag, file] = written[i];
    const bool can = can_force && flag == "-o";
    for (const Named& input : read)
      if (are_one_file(input.file, file) && !(can && forced))
        throw InputError(fmt::format("{} {}: this is an input file: name another{}", flag, file,
                                     can ? ", or overwrite it with --force" : ""));
    for (std::size_t k = 0; k < i; ++k)
      if (are_one_file(written[k].file, file))
        throw InputError(fmt::format("{} {} and {} {} are one file, of which one would be lost: name another",
                                     written[k].flag, written[k].file, flag, file));
  }
}

void require_writable_outputs(const Command& command) {
  for (const Option& o : command.options)
    if (is_output(o))
      for (const std::string& name : values_of(o))
        o.flags == "--out" ? require_writable_folder(name) : require_writable_file(name);
}

void write_result(const std::string& file, const std::string& json) {
  write_file(file, running ? result_files::with_provenance(json, provenance_of(*running)) : json);
}

std::string identity_of_run() {
  std::string out = fmt::format("program {}, {}\n", DEFLECT_VERSION, result_files::sha256(read_text("/proc/self/exe")));
  if (!running) return out;
  for (const std::string& word : words_of(*running)) out += "command " + word + "\n";
  for (const result_files::HashedFile& f : inputs_of(*running)) out += fmt::format("input {} {}\n", f.name, f.sha256);
  return out;
}

const Option* required_output(const Command& command) {
  for (const Option& o : command.options)
    if (o.required && is_output(o)) return &o;
  return nullptr;
}

std::vector<std::string> words_of(const Command& command) {
  std::vector<std::string> out = {command.name}, options;
  const auto add = [&](const Option& o) {
    for (const std::string& value : values_of(o)) {
      if (is_positional(o))
        out.push_back(value);
      else
        options.push_back(fmt::format("{}={}", long_flag(o), value));
    }
    if (const auto* flag = std::get_if<bool*>(&o.target); flag && **flag) options.push_back(long_flag(o));
  };
  for (const Option& o : command.options)
    if (!is_output(o) && !changes_nothing(o)) add(o);
  if (const Option* o = required_output(command)) add(*o);
  out.insert(out.end(), options.begin(), options.end());
  return out;
}

std::string hash_of(const std::string& name) {
  if (name == catalogue) return result_files::sha256(catalogue_text());
  const fs::path file = is_built_in(name) ? subject_file(name) : fs::path(name);
  std::error_code error;
  if (fs::exists(file, error) && !fs::is_regular_file(file, error)) return "";
  return result_files::sha256(read_text(file));
}

void remark_if_of_another(const std::string& result, const std::string& device, const subject::Subject& s) {
  const Json json = Json::parse(read_text(result), nullptr, false);
  if (!json.is_object() || !json.contains("device") || !json["device"].is_string()) return;  // said where it is read
  const std::string now = hash_of(device);
  // The fitted description itself has the name of its file.
  const std::vector<result_files::HashedFile> outputs = files_in(json, "/provenance/outputs");
  if (now.empty() || std::any_of(outputs.begin(), outputs.end(), [&](const auto& o) { return o.sha256 == now; }))
    return;
  if (const std::string of = json["device"]; of != s.name()) {
    remark(fmt::format("{} is of '{}', and this is '{}': what it says holds for the former", result, of, s.name()));
    return;
  }
  const Json subject = member(json, "/provenance/command/1");
  for (const result_files::HashedFile& read : files_in(json, "/provenance/inputs"))
    if (subject == read.name && !read.sha256.empty() && read.sha256 != now) {
      remark(
          fmt::format("{} is of another version of '{}': {} is not the file that was read then; what it says holds "
                      "for the former",
                      result, s.name(), device));
      return;
    }
}

bool has_read(const std::string& result, const std::string& file) {
  const std::string now = hash_of(file);
  const std::vector<result_files::HashedFile> inputs =
      files_in(Json::parse(read_text(result), nullptr, false), "/provenance/inputs");
  return !now.empty() && std::any_of(inputs.begin(), inputs.end(), [&](const auto& i) { return i.sha256 == now; });
}

void remark_if_of_other_data(const std::string& result, const std::vector<std::string>& files) {
  if (files_in(Json::parse(read_text(result), nullptr, false), "/provenance/inputs").empty()) return;
  for (const std::string& file : files)
    if (!has_read(result, file))
      remark(
          fmt::format("{} was not made from {} as it is now: the effects are as fitted then, and these readings count "
                      "as those that were taken so far",
                      result, file));
}

}  // namespace deflect::cli
