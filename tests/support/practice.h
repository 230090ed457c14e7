// Measurement sets of foreign make: those of tests/practice, or of the folder that DEFLECT_PRACTICE names.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "tests/support/paths.h"

namespace deflect::test {

/// The file of a set, "p02", where it is there.
inline std::optional<std::filesystem::path> practice_set(const std::string& set) {
  const char* named = std::getenv("DEFLECT_PRACTICE");
  const std::filesystem::path folder = named ? named : test::source_dir() + "/tests/practice";
  std::filesystem::path file = folder / (set + ".csv");
  if (!std::filesystem::exists(file)) return std::nullopt;
  return file;
}

}  // namespace deflect::test
