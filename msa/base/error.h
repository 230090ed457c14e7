// The three kinds of errors. Solvers report missing convergence in their result; code that needs an answer and gets
// none throws NumericalError.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace deflect {

/// Base of the three.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Bad input: a file, an option or a value the user wrote. The message names file, line, path, value and remedy.
struct InputError : Refusal {
  using Refusal::Refusal;
};

/// Why a model is impossible, without numbers, so that causes of the same kind compare equal.
struct Cause {
  std::string reason;  ///< "the link does not reach"; empty where only the message has it
  int leg = 0;         ///< 1-based, where one leg is the cause
};

/// An impossible model: an unreachable pose, a mechanism that cannot stand, a failed check. The message names the part.
struct ModelError : Refusal {
  explicit ModelError(const std::string& message, Cause why = {}) : Refusal(message), cause(std::move(why)) {}
  Cause cause;
};

/// Correct input whose solution was not found, or whose answer fails a check. The message contains the place, the check
/// and numbers.
struct NumericalError : Refusal {
  using Refusal::Refusal;
};

}  // namespace deflect
