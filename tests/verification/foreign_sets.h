// Measurement sets made by the foreign_*.py beside this file, with truth.json: what each of them hides.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/paths.h"
#include "validation/json/json_text.h"

namespace deflect::test {

/// An interval of a normal distribution misses by more than 1.6 times its half-width in two of a thousand.
inline constexpr double far_off = 1.6;

struct ForeignSets {
  std::filesystem::path own;     ///< the folder in the tests
  std::filesystem::path folder;  ///< that one, or the one that an environment variable names
  Json truths;                   ///< by set

  ForeignSets(const std::string& name, const char* variable)
      : own(std::filesystem::path(source_dir()) / "tests/verification" / name), folder(own) {
    if (const char* named = std::getenv(variable)) folder = named;
    std::ifstream file(folder / "truth.json");
    truths = Json::parse(file);
  }

  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (auto each = truths.begin(); each != truths.end(); ++each) out.push_back(each.key());
    return out;
  }
};

/// A set's name without its ending, as the name of a test may be.
inline std::string test_name(const std::string& set) {
  std::string name = set.substr(0, set.rfind('.'));
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

}  // namespace deflect::test
