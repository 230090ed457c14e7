// CSV text in tests: its lines, and some of its columns.
#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace deflect::test {

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

/// The columns of these names.
inline std::string columns(const std::string& text, const std::vector<std::string>& names) {
  std::vector<std::vector<std::string>> cells;
  for (const std::string& line : lines_of(text)) {
    cells.emplace_back();
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.back().push_back(cell);
  }
  std::string out;
  for (const auto& row : cells)
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto at = std::find(cells[0].begin(), cells[0].end(), names[i]) - cells[0].begin();
      out += row.at(static_cast<std::size_t>(at)) + (i + 1 < names.size() ? "," : "\n");
    }
  return out;
}

}  // namespace deflect::test
