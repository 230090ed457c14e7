// deflect: the stiffness of mechanisms by two independent theories. Exit codes: 0 done, 2 bad input or usage, 3 a model
// that cannot be, 4 a numerical failure, 70 a bug.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <new>
#include <thread>

#include "msa/base/error.h"
#include "validation/cli/command.h"
#include "validation/cli/talk.h"

namespace {

using deflect::cli::Command;
using deflect::cli::Option;

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

int fail(int code, const char* what, const char* message) {
  fmt::print(stderr, "deflect: {}{}\n", what, message);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  if (openblas_set_num_threads) openblas_set_num_threads(1);
  CLI::App app("deflect: how far a mechanism's tool point moves under load, by two independent theories", "deflect");
  app.set_version_flag("--version", DEFLECT_VERSION);
  app.require_subcommand(1);
  app.footer("Exit codes: 0 done, 2 bad input or usage, 3 a model that cannot be, 4 a numerical failure, 70 a bug.");

  using namespace deflect::cli;
  const std::vector<Command> commands = {solve_command(),   validate_command(), frame_command(),    map_command(),
                                         export_command(),  devices_command(),  check_command(),    effects_command(),
                                         add_command(),     compare_command(),  simulate_command(), diagnose_command(),
                                         history_command(), report_command()};
  std::vector<CLI::App*> parsers;
  bool quiet = false, loud = false;
  for (const Command& command : commands) {
    CLI::App* sub = app.add_subcommand(command.name, command.help);
    sub->footer("Example:\n  " + command.example);
    for (const Option& option : command.options) declare(*sub, option);
    CLI::Option* const q = sub->add_flag("--quiet", quiet, "print nothing but errors; files are written all the same");
    sub->add_flag("--verbose", loud, "tell every step with its time and choices on standard error")->excludes(q);
    parsers.push_back(sub);
  }
  try {
    app.parse(argc, argv);
    set_talk(quiet ? Talk::quiet : loud ? Talk::verbose : Talk::usual);
    tell("version {}, {} threads in this machine, BLAS {}", DEFLECT_VERSION, std::thread::hardware_concurrency(),
         openblas_set_num_threads ? "OpenBLAS, one thread" : "of the system");
    for (std::size_t i = 0; i < commands.size(); ++i)
      if (parsers[i]->parsed()) {
        const Step step(commands[i].name);
        commands[i].run();
      }
    if (std::fflush(stdout) != 0) return fail(2, "", "standard output cannot be written");
    return 0;
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  } catch (const deflect::InputError& e) {
    return fail(2, "", e.what());
  } catch (const deflect::ModelError& e) {
    return fail(3, "", e.what());
  } catch (const deflect::NumericalError& e) {
    return fail(4, "", e.what());
  } catch (const std::bad_alloc&) {
    return fail(4, "", "out of memory");
  } catch (const std::exception& e) {
    return fail(70, "a bug, please report it: ", e.what());
  }
}
