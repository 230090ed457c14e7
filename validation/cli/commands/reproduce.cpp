#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/outcome.h"
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
  if (input.sha256.empty()) return fmt::format("{} was a pipe or a device: what it held is gone", input.name);
  const auto now = outcome_of<InputError>([&] { return hash_of(input.name); });
  if (!now) return fmt::format("{} is missing", input.name);
  return *now == input.sha256 ? "" : fmt::format("{} has changed", input.name);
}

/// Of the inputs, seen from the current folder.
std::vector<std::string> all_changed(const Provenance& p) {
  std::vector<std::string> out;
  for (const HashedFile& input : p.inputs)
    if (std::string words = changed(input); !words.empty()) out.push_back(std::move(words));
  return out;
}

/// Goes to the folder from which all inputs are found as they were: the current one, or that of the result.
void go_to_inputs(const Provenance& p, const fs::path& result) {
  const fs::path here = fs::current_path(), there = fs::absolute(result).lexically_normal().parent_path();
  std::string words;
  for (const fs::path& folder : here == there ? std::vector<fs::path>{here} : std::vector<fs::path>{here, there}) {
    fs::current_path(folder);
    const std::vector<std::string> changes = all_changed(p);
    if (changes.empty()) return;
    words += fmt::format(" Seen from {}: {}.", folder.string(), fmt::join(changes, "; "));
  }
  fs::current_path(here);
  throw InputError(
      fmt::format("{}: its inputs are not as they were.{} Put them back into one of these folders, or make the result "
                  "again",
                  result.string(), words));
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

std::string ending(const parallel::ChildOutcome& outcome) {
  if (outcome.start_error != 0) return "cannot be started";
  if (WIFSIGNALED(outcome.status)) return fmt::format("is ended by signal {}", WTERMSIG(outcome.status));
  return fmt::format("ends with exit code {}", WEXITSTATUS(outcome.status));
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
    throw NumericalError(fmt::format("{}: 'deflect {}' now {}: {}", result, fmt::join(p.command, " "), ending(outcome),
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
  go_to_inputs(p, a.result);
  const Scratch scratch;
  const Json again = json::parse_json(timed(fmt::format("deflect {}", fmt::join(p.command, " ")),
                                            [&] { return run_again(p, a.result, scratch.path()); }),
                                      "the result made anew", "this is a bug");
  const Provenance now = result_files::read_provenance(again, "the result made anew");
  std::vector<std::string> others = result_files::differences(before, again, a.tolerance, most_shown);
  for (std::size_t i = 0; i < std::min(p.outputs.size(), now.outputs.size()); ++i)
    if (!p.outputs[i].sha256.empty() && p.outputs[i].sha256 != now.outputs[i].sha256)
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
  return {"reproduce",
          "Run the command that made a result file again, and compare. The file's provenance names the command, the "
          "version and the machine, and its inputs by their hashes (SHA-256). Inputs are looked for in the current "
          "folder, then in that of the result. Numbers must agree to --tolerance, all else exactly. Exit code 0: the "
          "same; 4: not, with the first differences; 2: an input is missing or has changed",
          "deflect reproduce diagnosis.json",
          {{"result", "RESULT.json", "a result written by --json", &a->result, true},
           {"--tolerance", "X", "relative difference of numbers to ignore (default 1e-9)", &a->tolerance},
           {"--json", "FILE", "write the differences", &a->json}},
          [a] { run(*a); }};
}

}  // namespace deflect::cli
