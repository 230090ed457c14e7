#include "validation/report/text.h"

#include <algorithm>

#include "msa/base/index.h"

namespace deflect::report {
namespace {

bool starts_letter(char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }

}  // namespace

std::size_t letters(std::string_view utf8) { return as_size(std::count_if(utf8.begin(), utf8.end(), starts_letter)); }

std::string clip(std::string_view utf8, std::size_t most) {
  if (letters(utf8) <= most) return std::string(utf8);
  std::size_t bytes = 0, seen = 0;
  for (; bytes < utf8.size(); ++bytes)
    if (starts_letter(utf8[bytes]) && ++seen == most) break;
  return std::string(utf8.substr(0, bytes)) + "…";
}

std::string counted(std::size_t number, std::string_view one) {
  return std::to_string(number) + ' ' + std::string(one) + (number == 1 ? "" : "s");
}

std::string csv_cell(std::string_view text) {
  std::string cell = "\"";
  for (const char c : text) cell.append(c == '"' ? 2 : 1, c);
  return cell + '"';
}

std::string with_minus(std::string_view utf8) {
  std::string out;
  for (std::size_t i = 0; i < utf8.size(); ++i) {
    const bool sign = utf8[i] == '-' && i + 1 < utf8.size() && utf8[i + 1] >= '0' && utf8[i + 1] <= '9' &&
                      (i == 0 || std::string_view(" (,").find(utf8[i - 1]) != std::string_view::npos);
    out += sign ? std::string("−") : std::string(1, utf8[i]);
  }
  return out;
}

std::vector<std::string> wrap(std::string_view text, std::size_t most) {
  std::vector<std::string> lines(1);
  while (!text.empty()) {
    const std::size_t space = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, space);
    if (!lines.back().empty() && letters(lines.back()) + 1 + letters(word) > most) lines.emplace_back();
    lines.back().append(lines.back().empty() ? "" : " ").append(word);
    text.remove_prefix(std::min(space + 1, text.size()));
  }
  return lines;
}

std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], letters(row[i]));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - letters(row[i]), ' ');
      line += i == 0 ? row[i] + padding : "  " + padding + row[i];
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace deflect::report
