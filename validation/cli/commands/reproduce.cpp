#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "validation/cli/command.h"
#include "validation/cli/made_by.h"
#include "validation/cli/talk.h"
#include "validation/parallel/child_process.h"
#include "validation/result_files/provenance.h"

namespace deflect::cli {
namespace {

namespace fs = std::filesystem;
using result_files::HashedFile;
using result_files::Provenance;

constexpr std::size_t most_shown = 10;
constexpr const char* output_option = "--output=";

struct ReproduceArguments {
  std::string result, json;
  double tolerance = 1e-9;
  std::vector<std::string> commands;  ///< that write results
};

/// A folder for what the run writes, removed in the end.
class Scratch {
 public:
  Scratch() {
    std::string name = (fs::temp_directory_path() / "deflect-reproduce-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw InputError(fmt::format("{}: cannot be made", name));
    path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// "hidden.csv is missing", "hidden.csv has changed"; empty where it is as it was.
std::string changed(const HashedFile& input) {
  if (input.sha256.empty()) return fmt::format("{} was no file: what it held is gone", input.name);
  std::error_code error;
  const bool named = input.name.find('/') != input.name.npos || input.name.find('.') != input.name.npos;
  if (named && input.name != "effects/catalogue" && !fs::exists(input.name, error))
    return fmt::format("{} is missing", input.name);
  return hash_of(input.name) == input.sha256 ? "" : fmt::format("{} has changed", input.name);
}

/// Inputs are looked for in the current folder, then in that of the result.
void require_inputs(const Provenance& p, const fs::path& result) {
  const auto all_changed = [&] {
    std::vector<std::string> out;
    for (const HashedFile& input : p.inputs)
      if (std::string words = changed(input); !words.empty()) out.push_back(std::move(words));
    return out;
  };
  const std::vector<std::string> here = all_changed();
  if (here.empty()) return;
  const fs::path before = fs::current_path();
  fs::current_path(fs::absolute(result).parent_path());
  if (all_changed().empty()) return;
  fs::current_path(before);
  throw InputError(
      fmt::format("{}: {}: give the inputs that it was made from", result.string(), fmt::join(here, "; ")));
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// Runs the command anew, with what it writes in the scratch folder; its result, in which that folder's file has the
/// name that it had.
std::string run_again(const Provenance& p, const std::string& result, const fs::path& scratch) {
  std::vector<std::string> words = {fs::read_symlink("/proc/self/exe").string()};
  std::string was, is;
  for (std::string word : p.command) {
    if (word.starts_with(output_option)) {
      was = word.substr(std::string_view(output_option).size());
      is = (scratch / fs::path(was).filename()).string();
      word = output_option + is;
    }
    words.push_back(std::move(word));
  }
  const fs::path written = scratch / "result.json";
  words.push_back("--quiet");
  words.push_back("--json=" + written.string());
  const parallel::ChildOutcome outcome = parallel::run_child(words, "");
  if (!outcome.succeeded())
    throw NumericalError(fmt::format("{}: 'deflect {}' now ends with exit code {}: {}", result,
                                     fmt::join(p.command, " "), WEXITSTATUS(outcome.status),
                                     outcome.errors.substr(0, outcome.errors.find('\n'))));
  const std::string text = read_text(written);
  return was.empty() ? text : replaced(text, is, was);
}

/// What is another than it was, beside the numbers.
std::vector<std::string> elsewhere(const Provenance& before, const Provenance& now) {
  std::vector<std::string> out;
  const auto tell = [&](const char* what, const std::string& was, const std::string& is) {
    if (was != is) out.push_back(fmt::format("{}: {} instead of {}", what, is, was));
  };
  tell("program", before.program, now.program);
  tell("system", before.system, now.system);
  tell("processor", before.processor, now.processor);
  tell("compiler", before.compiler, now.compiler);
  return out;
}

void require_command(const Provenance& p, const ReproduceArguments& a) {
  if (std::find(a.commands.begin(), a.commands.end(), p.command.front()) == a.commands.end())
    throw InputError(fmt::format("{}: provenance.command: '{}' is no command that writes results: {}", a.result,
                                 p.command.front(), fmt::join(a.commands, ", ")));
  for (const std::string& word : p.command)
    if (word.starts_with("--json") || word.starts_with("--out=") || word.starts_with("--report") || word == "-o")
      throw InputError(fmt::format("{}: provenance.command: '{}' would write a file", a.result, word));
}

void run(const ReproduceArguments& a) {
  if (!(a.tolerance >= 0 && a.tolerance < 1))
    throw InputError(fmt::format("--tolerance {:g}: give a relative difference from 0 to 1", a.tolerance));
  const std::string json = a.json.empty() ? "" : fs::absolute(a.json).string();
  const Json before = json::parse_json(read_text(a.result), a.result, "give a result that --json wrote, whole");
  const Provenance p = result_files::read_provenance(before, a.result);
  require_command(p, a);
  require_inputs(p, a.result);
  const Scratch scratch;
  const Json again = json::parse_json(timed(fmt::format("deflect {}", fmt::join(p.command, " ")),
                                            [&] { return run_again(p, a.result, scratch.path()); }),
                                      "the result made anew", "this is a bug");
  const Provenance now = result_files::read_provenance(again, "the result made anew");
  std::vector<std::string> others = result_files::differences(before, again, a.tolerance, most_shown);
  for (std::size_t i = 0; i < std::min(p.outputs.size(), now.outputs.size()); ++i)
    if (p.outputs[i].sha256 != now.outputs[i].sha256)
      others.push_back(fmt::format("provenance.outputs[{}]: {} is another file", i, p.outputs[i].name));
  const std::vector<std::string> where = elsewhere(p, now);
  if (!json.empty())
    write_result(json, json::json_text(Json{{"kind", "reproduction"},
                                            {"result", a.result},
                                            {"same", others.empty()},
                                            {"tolerance", a.tolerance},
                                            {"differences", others},
                                            {"made_elsewhere", where}}));
  for (const std::string& line : where) remark(line);
  if (!others.empty())
    throw NumericalError(fmt::format("{}: not reproduced:\n  {}", a.result, fmt::join(others, "\n  ")));
  fmt::print("{}: reproduced: 'deflect {}' gives the same, numbers to {:g}\n", a.result, fmt::join(p.command, " "),
             a.tolerance);
}

}  // namespace

Command reproduce_command(const std::vector<Command>& others) {
  auto a = std::make_shared<ReproduceArguments>();
  for (const Command& command : others)
    for (const Option& o : command.options)
      if (o.flags == "--json") a->commands.push_back(command.name);
  return {
      "reproduce",
      "Run again what a result file was made by, and compare. The file's provenance names the command, the version "
      "and the machine, and its inputs by their hashes (SHA-256). Inputs are looked for in the current folder, then "
      "in that of the result. Numbers must agree to --tolerance, all else exactly. Exit code 0: the same; 4: not, "
      "with the first differences; 2: an input is missing or has changed",
      "deflect reproduce diagnosis.json",
      {{"result", "RESULT.json", "a result written by --json", &a->result, true},
       {"--tolerance", "X", "relative difference of numbers to ignore (default 1e-9)", &a->tolerance},
       {"--json", "FILE", "write the differences", &a->json}},
      [a] { run(*a); }};
}

}  // namespace deflect::cli
