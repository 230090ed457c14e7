// A command of the program: its options as data, so that only main.cpp knows the parser, and what it does.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace deflect::cli {

struct Option {
  std::string flags;  ///< "--load", or "device" for a positional argument
  std::string value;  ///< what to write for the value in the help: "fx,fy,fz,mx,my,mz"; empty for a flag
  std::string help;
  std::variant<std::string*, bool*, double*, std::vector<std::string>*> target;
  bool required = false;
};

/// run() prints the report for a person on standard output and throws InputError, ModelError or NumericalError.
struct Command {
  std::string name, help, example;
  std::vector<Option> options;
  std::function<void()> run;
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

}  // namespace deflect::cli
