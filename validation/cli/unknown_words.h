// Messages for unknown commands and options, with the nearest known ones.
#pragma once

#include <string>
#include <vector>

#include "validation/cli/command.h"

namespace deflect::cli {

/// The message for arguments that the parser refused: an unknown command, or an unknown option of a command. Empty if
/// all are known.
std::string unknown_word(const std::vector<Command>&, const std::vector<std::string>& arguments);

}  // namespace deflect::cli
