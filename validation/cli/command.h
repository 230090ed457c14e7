// A command of the program: its options as data, so that only main.cpp knows the parser, and the work it does.
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
  std::string value;  ///< placeholder of the value in the help: "fx,fy,fz,mx,my,mz"; empty for a flag
  std::string help;
  std::variant<std::string*, bool*, double*, std::vector<std::string>*> target;
  bool required = false;
};

/// The work of a command: it prints a report on standard output and writes files. Throws InputError, ModelError or
/// NumericalError. Run is called on the first rank only. SharedRun divides its work among the ranks that it is given
/// (nullptr: this process is the only one); it prints and writes on the first rank only.
using Run = std::function<void()>;
using SharedRun = std::function<void(parallel::Ranks*)>;

struct Command {
  std::string name, help, example;
  std::vector<Option> options;
  std::variant<Run, SharedRun> run;
};

}  // namespace deflect::cli
