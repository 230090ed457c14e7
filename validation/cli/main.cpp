// deflect: the stiffness of mechanisms by two independent theories. Exit codes: 0 done, 2 bad input or usage, 3 an
// impossible model, 4 a numerical failure, 70 a bug.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <sstream>
#include <system_error>
#include <thread>

#include "msa/base/error.h"
#include "msa/base/memory.h"
#include "validation/cli/command.h"
#include "validation/cli/completion.h"
#include "validation/cli/made_by.h"
#include "validation/cli/talk.h"
#include "validation/cli/unknown_words.h"
#include "validation/parallel/ranks.h"

// A command is its file in commands/, its declaration here, and its place in the help below.
namespace deflect::cli {
Command new_command(), show_command(), solve_command(), validate_command(), frame_command(), map_command(),
    export_command(), devices_command(), check_command(), effects_command(), add_command(), compare_command(),
    simulate_command(), diagnose_command(), history_command(), report_command();
Command fit_command(), predict_command(), plan_command();
Command reproduce_command(const std::vector<Command>& others);
}  // namespace deflect::cli

namespace {

using deflect::cli::Command;
using deflect::cli::Option;
using deflect::parallel::Ranks;

// OpenBLAS, where it is the BLAS: one thread, since the systems of mechanisms are small and threads only cost.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));

void declare(CLI::App& app, const Option& option) {
  CLI::Option* o = std::visit(
      [&](auto* target) -> CLI::Option* {
        if constexpr (std::is_same_v<decltype(target), bool*>)
          return app.add_flag(option.flags, *target, option.help);
        else
          return app.add_option(option.flags, *target, option.help)->type_name(option.value);
      },
      option.target);
  o->required(option.required);
}

/// Returns false if the arguments only request help or the version, which it prints.
bool parse(CLI::App& app, const std::vector<Command>& commands, int argc, char** argv, bool say) try {
  app.parse(argc, argv);
  return true;
} catch (const CLI::ParseError& e) {
  std::ostringstream asked, wrong;
  app.exit(e, asked, wrong);
  if (say) fmt::print("{}", asked.str());
  if (e.get_exit_code() == 0) return false;
  std::string text = deflect::cli::unknown_word(commands, {argv + 1, argv + argc});
  if (!text.empty()) throw deflect::InputError(text);
  text = wrong.str();
  while (!text.empty() && text.back() == '\n') text.pop_back();
  throw deflect::InputError(text);
}

void run(const Command& command, Ranks* ranks) {
  const deflect::cli::Step step(command.name);
  deflect::cli::set_command(command);
  deflect::cli::require_separate_files(command);
  deflect::cli::require_writable_outputs(command);
  if (const auto* shared = std::get_if<deflect::cli::SharedRun>(&command.run)) {
    (*shared)(ranks);
  } else if (!ranks || ranks->first()) {
    if (ranks)
      deflect::cli::say(fmt::format("deflect: {} runs on one of the {} processes: its work is not divided\n",
                                    command.name, ranks->size()));
    std::get<deflect::cli::Run>(command.run)();
  }
}

/// A printed word that is lost ends the run: fmt throws where a buffer is full, the rest is flushed here.
template <class Work>
void printing(const Work& work) try {
  work();
  if (std::fflush(stdout) != 0) throw deflect::InputError("standard output cannot be written");
} catch (const std::system_error&) {
  if (std::ferror(stdout)) throw deflect::InputError("standard output cannot be written");
  throw;
}

}  // namespace

int main(int argc, char** argv) {
  deflect::keep_freed_memory();
  if (openblas_set_num_threads) openblas_set_num_threads(1);
  CLI::App app("deflect: how far a mechanism's tool point moves under load, by two independent theories", "deflect");
  app.set_version_flag("--version", DEFLECT_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(32);  // two blanks at least between "--pose x,y,z,roll,pitch,yaw" and its help
  app.footer(
      "Exit codes: 0 done, 2 bad input or usage, 3 an impossible model (unreachable pose, unstable mechanism), 4 a "
      "numerical failure, 70 a bug.");

  using namespace deflect::cli;
  std::vector<Command> commands = {new_command(),      show_command(),     solve_command(),   validate_command(),
                                   frame_command(),    map_command(),      export_command(),  devices_command(),
                                   check_command(),    effects_command(),  add_command(),     compare_command(),
                                   simulate_command(), diagnose_command(), history_command(), report_command(),
                                   fit_command(),      predict_command(),  plan_command()};
  commands.push_back(reproduce_command(commands));
  commands.push_back(completion_command(commands));
  std::vector<CLI::App*> parsers;
  bool quiet = false, loud = false;
  for (const Command& command : commands) {
    CLI::App* sub = app.add_subcommand(command.name, command.help);
    sub->footer("Example:\n  " + command.example);
    for (const Option& option : command.options) declare(*sub, option);
    CLI::Option* const q = sub->add_flag("--quiet", quiet, "print only errors; files are still written");
    sub->add_flag("--verbose", loud, "print every step with its time and choices on standard error")->excludes(q);
    parsers.push_back(sub);
  }
  const bool first = deflect::parallel::launched().rank == 0;
  const auto work = [&](Ranks* ranks) {
    if (!parse(app, commands, argc, argv, first)) return;
    set_talk(quiet || !first ? Talk::quiet : loud ? Talk::verbose : Talk::usual);
    tell("version {}, {} threads in this machine, BLAS {}", DEFLECT_VERSION, std::thread::hardware_concurrency(),
         openblas_set_num_threads ? "OpenBLAS, one thread" : "of the system");
    if (ranks) tell("{} processes, {} threads in each", ranks->size(), ranks->threads());
    for (std::size_t i = 0; i < commands.size(); ++i)
      if (parsers[i]->parsed()) run(commands[i], ranks);
  };
  const auto whole = [&](Ranks* ranks) { printing([&] { work(ranks); }); };
  return deflect::parallel::run_on_ranks(whole, [](const deflect::Ending& end) {
    say(fmt::format("deflect: {}{}\n", end.code == 70 ? "a bug, please report it: " : "", end.message));
  });
}
