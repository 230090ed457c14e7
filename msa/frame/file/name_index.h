// Index of a name in a list of named things, in constant time, because the lists of a frame can be long.
#pragma once

#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace deflect::frame {

class NameIndex {
 public:
  NameIndex() = default;

  template <class T>
  explicit NameIndex(const std::vector<std::pair<std::string, T>>& list) {
    for (const auto& [name, value] : list) index_.emplace(name, static_cast<int>(index_.size()));
  }

  /// −1 where the name is unknown.
  int find(const std::string& name) const {
    const auto found = index_.find(name);
    return found == index_.end() ? -1 : found->second;
  }

 private:
  std::unordered_map<std::string, int> index_;
};

}  // namespace deflect::frame
