// Lists of named values.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace deflect {

/// A list of named values in the order of the file.
template <class T>
using Named = std::vector<std::pair<std::string, T>>;

template <class T>
const T* find(const Named<T>& list, const std::string& name) {
  for (const auto& [key, value] : list)
    if (key == name) return &value;
  return nullptr;
}

}  // namespace deflect
