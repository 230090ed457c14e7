// Commands and options that the program does not know, and the nearest that it does.
#pragma once

#include <string>
#include <vector>

#include "validation/cli/command.h"

namespace deflect::cli {

/// What to say of arguments that the parser refused: the command that is not there, or an option that the command does
/// not have. Empty where all of them are known.
std::string unknown_word(const std::vector<Command>&, const std::vector<std::string>& arguments);

}  // namespace deflect::cli
