// The names of the catalogue's effects, read off its files: for lists of tests, which every run of one test makes.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/paths.h"

namespace deflect::test {

inline std::vector<std::string> catalogue_names() {
  std::vector<std::string> out;
  for (const auto& file : std::filesystem::directory_iterator(source_dir() + "/validation/effects/catalogue"))
    out.push_back(file.path().stem().string());
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace deflect::test
