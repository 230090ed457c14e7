// How many random models the tests judge, and where they write the ones that fail.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace deflect::attack {

/// DEFLECT_ATTACK=10000 judges as many.
inline unsigned count_from_environment(unsigned usual) {
  const char* text = std::getenv("DEFLECT_ATTACK");
  return text ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : usual;
}

/// Tests run side by side, each on every tenth seed.
inline constexpr unsigned shards = 10;

inline std::filesystem::path failures_folder() {
  const std::filesystem::path folder = std::filesystem::current_path() / "attack";
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace deflect::attack
