// The three ways in which work is refused. Solvers return a missing convergence in their result; what asks for an
// answer and gets none throws it as NumericalError.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace deflect {

/// Work that is refused, whichever way.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Bad input: a file, an option or a value the user wrote. The message names file, line, path, value and remedy.
struct InputError : Refusal {
  using Refusal::Refusal;
};

/// What made a model impossible, without the numbers: equal wherever the same thing is wrong.
struct Cause {
  std::string reason;  ///< "the link does not reach"; empty where only the message says it
  int leg = 0;         ///< from 1, where one leg is to blame
};

/// An impossible model: an unreachable pose, a mechanism that cannot stand, a failed check. Names the part.
struct ModelError : Refusal {
  explicit ModelError(const std::string& message, Cause why = {}) : Refusal(message), cause(std::move(why)) {}
  Cause cause;
};

/// Correct input whose solution was not found, or whose answer fails a check. Names the place, the check and numbers.
struct NumericalError : Refusal {
  using Refusal::Refusal;
};

}  // namespace deflect
