// A helper program run to its end with text for its standard input.
#pragma once

#include <string>
#include <vector>

namespace deflect::parallel {

struct ChildOutcome {
  int start_error = 0;  ///< errno where the program could not be started, else 0
  int status = 0;       ///< as waitpid gives it
  std::string output, errors;

  bool succeeded() const;  ///< started and ended with exit code 0
};

/// The program is looked for on the PATH; nothing passes through a shell. Throws InputError where there is no memory
/// for what it writes.
ChildOutcome run_child(std::vector<std::string> words, const std::string& input);

}  // namespace deflect::parallel
