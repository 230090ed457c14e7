#include "validation/measurement/csv_titles.h"

#include <algorithm>
#include <cctype>
#include <vector>

namespace deflect::measurement {
namespace {

constexpr std::size_t most_titles = 30;  // lines

std::string_view stripped(std::string_view s, std::string_view of) {
  const auto from = s.find_first_not_of(of);
  return from == s.npos ? std::string_view() : s.substr(from, s.find_last_not_of(of) - from + 1);
}

/// The cells of a line that are not empty.
std::vector<std::string_view> filled_cells(std::string_view line, char separator) {
  std::vector<std::string_view> out;
  bool quoted = false;
  for (std::size_t i = 0, begin = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (quoted || line[i] != separator)) continue;
    if (const std::string_view cell = stripped(line.substr(begin, i - begin), " \t\""); !cell.empty())
      out.push_back(cell);
    begin = i + 1;
  }
  return out;
}

bool begins_number(std::string_view cell) {
  const std::size_t sign = cell.front() == '-' || cell.front() == '+' ? 1 : 0;
  return sign < cell.size() && std::isdigit(static_cast<unsigned char>(cell[sign])) != 0;
}

bool has_number(const std::vector<std::string_view>& cells) {
  return std::any_of(cells.begin(), cells.end(), begins_number);
}

/// As cells of the separator that stands in it most often.
std::vector<std::string_view> own_cells(std::string_view line, char& separator) {
  std::vector<std::string_view> most;
  for (const char each : {',', ';', '\t'})
    if (std::vector<std::string_view> cells = filled_cells(line, each); cells.size() > most.size())
      most = std::move(cells), separator = each;
  return most;
}

}  // namespace

std::optional<std::string_view> told_separator(std::string_view line) {
  std::string_view told = stripped(line, " \r\n");
  if (told.size() > 2 && told.front() == '"' && told.back() == '"') told = told.substr(1, told.size() - 2);
  constexpr std::string_view key = "sep=";
  if (told.size() < key.size()) return std::nullopt;
  for (std::size_t i = 0; i < key.size(); ++i)
    if (std::tolower(static_cast<unsigned char>(told[i])) != key[i]) return std::nullopt;
  return told.substr(key.size());
}

std::optional<std::size_t> header_below(std::string_view text) {
  std::size_t widest = 0;
  char separator = ',';
  for (std::size_t k = 0; k < most_titles && !text.empty(); ++k) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = stripped(text.substr(0, end), "\r");
    if (std::count(line.begin(), line.end(), '"') % 2 != 0) return std::nullopt;  // a cell of several lines
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::vector<std::string_view> cells = own_cells(line, separator);
    if (k > 0 && cells.size() > std::max<std::size_t>(widest, 1) && !has_number(cells)) {
      const std::vector<std::string_view> below =
          filled_cells(stripped(text.substr(0, text.find('\n')), "\r"), separator);
      if (below.size() <= cells.size() && 2 * below.size() > cells.size() && has_number(below)) return k;
    }
    widest = std::max(widest, cells.size());
  }
  return std::nullopt;
}

}  // namespace deflect::measurement
