// How many random models the tests judge, and where they write the ones that fail.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace deflect::attack {

/// Models in the daily tests, which run side by side, each on every tenth seed.
inline constexpr unsigned usual_count = 500, shards = 10;

inline unsigned number_of_environment(const char* name) {
  const char* text = std::getenv(name);
  return text ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : 0;
}

/// DEFLECT_ATTACK=10000 judges as many in one go and prints the table of outcomes; 0: not asked for.
inline unsigned count_on_demand() { return number_of_environment("DEFLECT_ATTACK"); }

/// DEFLECT_ATTACK_FROM=300: the seed to begin with, where an earlier run has stopped.
inline unsigned first_on_demand() { return number_of_environment("DEFLECT_ATTACK_FROM"); }

inline std::filesystem::path failures_folder() {
  const std::filesystem::path folder = std::filesystem::current_path() / "attack";
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace deflect::attack
