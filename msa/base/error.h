// The two ways in which work can be refused. Numerical outcomes that correct input can produce (no
// convergence, singular at this load) are not errors of this kind: they come back in results.
#pragma once

#include <stdexcept>
#include <string>

namespace deflect {

/// Bad input: a file, an option or a value the user wrote. The message names file, line, path, value and remedy.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An impossible model: an unreachable pose, a mechanism that cannot stand, a failed check. Names the part.
struct ModelError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Correct input whose solution was not found; thrown at the command's edge when a result says so.
struct NumericalError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace deflect
