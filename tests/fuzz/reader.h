// What every target does: a reader refuses what it is given with an InputError or a ModelError, or reads it; what it
// has read is written and read back as the same. Anything else, a memory error or undefined behaviour ends the program.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "msa/base/error.h"

namespace deflect::fuzz {

/// Ends the program where what was written does not read back as the same.
inline void require_same(const std::string& first, const std::string& second) {
  if (first == second) return;
  std::fprintf(stderr, "written:\n%s\nread and written again:\n%s\n", first.c_str(), second.c_str());
  std::abort();
}

/// `write_read(text)`: what is read from the text, as a file. Its own file must be read.
template <class F>
int round_trip(const std::uint8_t* data, std::size_t size, const F& write_read) {
  std::string once;
  try {
    once = write_read(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const InputError&) {
    return 0;
  } catch (const ModelError&) {
    return 0;
  }
  require_same(once, write_read(once));
  return 0;
}

}  // namespace deflect::fuzz
