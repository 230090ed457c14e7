// Shell completion of command lines, made from the tables of the commands.
#pragma once

#include <string>
#include <vector>

#include "validation/cli/command.h"

namespace deflect::cli {

/// What the shell offers for an option's value, by its placeholder in the help: "DEVICE" → built-in devices and files;
/// "msh|vtk" → both words. Empty if the values cannot be listed, as for a number.
struct Choices {
  std::vector<std::string> words;
  bool files = false, folders = false;
};
Choices choices_of(const std::string& value);

/// A bash script that completes commands, options, names of devices, effects and frames, and files.
std::string bash_completion(const std::vector<Command>&);

/// `deflect completion bash`; it completes these commands and itself.
Command completion_command(const std::vector<Command>& others);

}  // namespace deflect::cli
