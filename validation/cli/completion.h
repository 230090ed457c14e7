// What the shell needs to complete the words of a command line, made from the tables of the commands.
#pragma once

#include <string>
#include <vector>

#include "validation/cli/command.h"

namespace deflect::cli {

/// Words that stand for themselves where an option's value, as its help writes it, asks for them: "DEVICE" → the
/// built-in ones, and their files too. "msh|vtk" → both. Nothing where the value cannot be listed, as a number.
struct Choices {
  std::vector<std::string> words;
  bool files = false, folders = false;
};
Choices choices_of(const std::string& value);

/// A script for bash that completes `deflect`: commands, their options, names of devices, effects and frames, files.
std::string bash_completion(const std::vector<Command>&);

/// `deflect completion bash`, of all these and of itself.
Command completion_command(const std::vector<Command>& others);

}  // namespace deflect::cli
