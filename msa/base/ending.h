// How a run ends: exit codes of the program, and errors as values that can be sent to other processes.
#pragma once

#include <exception>
#include <string>

namespace deflect {

/// 0 done, 2 bad input or usage (InputError, a path that the system refuses), 3 an impossible model (ModelError), 4 a
/// numerical failure (NumericalError, out of memory), 70 a bug (everything else).
struct Ending {
  int code = 0;
  std::string message;
};

Ending ending_of(const std::exception_ptr&);

/// Throws an exception with that ending.
[[noreturn]] void throw_ending(const Ending&);

}  // namespace deflect
