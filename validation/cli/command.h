// A command of the program: its options as data, so that only main.cpp knows the parser, and what it does.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "validation/parallel/ranks.h"

namespace deflect::cli {

struct Option {
  std::string flags;  ///< "--load", or "device" for a positional argument
  std::string value;  ///< what to write for the value in the help: "fx,fy,fz,mx,my,mz"; empty for a flag
  std::string help;
  std::variant<std::string*, bool*, double*, std::vector<std::string>*> target;
  bool required = false;
};

/// What a command does: print the report for a person on standard output, write files; throws InputError, ModelError or
/// NumericalError. One that can share its work takes the ranks of the run, nullptr where this process is the only one,
/// and prints and writes on the first rank only; another one is run there alone.
using Run = std::function<void()>;
using SharedRun = std::function<void(Ranks*)>;

struct Command {
  std::string name, help, example;
  std::vector<Option> options;
  std::variant<Run, SharedRun> run;
};

Command solve_command();
Command validate_command();
Command frame_command();
Command map_command();
Command export_command();
Command devices_command();
Command check_command();
Command compare_command();
Command diagnose_command();
Command history_command();
Command report_command();
Command simulate_command();
Command effects_command();
Command add_command();
Command new_command();
Command show_command();

}  // namespace deflect::cli
