#include "tests/house/counts.h"

#include <algorithm>
#include <iterator>
#include <regex>
#include <sstream>

namespace deflect::house {
namespace {

/// The lines of a file without what follows "//" in them.
std::vector<std::string> code_lines(const Source& source) {
  std::vector<std::string> lines;
  std::istringstream text(source.text);
  for (std::string line; std::getline(text, line);) lines.push_back(line.substr(0, line.find("//")));
  return lines;
}

std::string place(const Source& source, std::size_t line) { return source.path + ":" + std::to_string(line + 1); }

/// The signature that begins on this line, on one line up to its "{"; empty where none does.
std::string signature_at(const std::vector<std::string>& lines, std::size_t i) {
  std::string whole = lines[i];
  for (std::size_t k = i + 1; k < std::min(i + 8, lines.size()) && !whole.empty(); ++k) {
    if (whole.ends_with('{') || whole.ends_with(';') || whole.ends_with('}')) break;
    const std::size_t first = lines[k].find_first_not_of(' ');
    if (first == std::string::npos) return "";
    whole += " " + lines[k].substr(first);
  }
  return whole.ends_with('{') ? whole : "";
}

/// Whether a function of the first level, or of a class or a namespace at it, begins so: not with a keyword.
bool begins_function(const std::string& line) {
  static const std::regex free(R"(^[A-Za-z].*\{$)"), member(R"(^  [A-Za-z].*\).* ?\{$)"),
      other(
          R"(^ *(namespace|struct|class|enum|union|constexpr|inline constexpr|static|for|if|while|switch|else|do)\b.*)");
  return (std::regex_match(line, free) || std::regex_match(line, member)) && !std::regex_match(line, other);
}

}  // namespace

std::vector<std::string> named_in(const std::vector<Source>& sources, const std::vector<std::string>& rooms,
                                  const std::vector<std::string>& words) {
  std::vector<std::string> found;
  for (const Source& source : sources) {
    if (std::find(rooms.begin(), rooms.end(), room_of(source.path)) == rooms.end()) continue;
    const std::vector<std::string> lines = code_lines(source);
    for (std::size_t i = 0; i < lines.size(); ++i)
      for (const std::string& word : words)
        if (std::regex_search(lines[i], std::regex("\\b" + word + "\\b")))
          found.push_back(place(source, i) + ": names " + word);
  }
  return found;
}

std::vector<std::string> long_functions(const std::vector<Source>& sources, int limit,
                                        const std::vector<std::string>& tables) {
  std::vector<std::string> found;
  for (const Source& source : sources) {
    const std::vector<std::string> lines = code_lines(source);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (!begins_function(signature_at(lines, i))) continue;
      const std::string end = std::string(lines[i].find_first_not_of(' '), ' ') + "}";
      // What ends at the first level before it was no function of a class.
      const auto last = std::find_if(lines.begin() + static_cast<std::ptrdiff_t>(i) + 1, lines.end(),
                                     [&](const std::string& line) { return line == end || line.starts_with('}'); });
      if (last == lines.end() || *last != end) continue;
      const auto length = last - lines.begin() - static_cast<std::ptrdiff_t>(i) + 1;
      const bool table = std::any_of(tables.begin(), tables.end(), [&](const std::string& t) {
        const std::size_t colon = t.find(": ");
        return source.path == t.substr(0, colon) && lines[i].find(t.substr(colon + 2)) != std::string::npos;
      });
      if (length > limit && !table) found.push_back(place(source, i) + ": " + std::to_string(length) + " lines");
    }
  }
  return found;
}

int index_casts(const std::vector<Source>& sources) {
  static const std::regex cast(
      "static_cast<(std::size_t|Eigen::Index|int|Index|std::ptrdiff_t|unsigned|std::uint32_t)>");
  int count = 0;
  for (const Source& source : sources)
    count += static_cast<int>(
        std::distance(std::sregex_iterator(source.text.begin(), source.text.end(), cast), std::sregex_iterator()));
  return count;
}

std::vector<std::string> catches(const std::vector<Source>& sources) {
  std::vector<std::string> found;
  for (const Source& source : sources) {
    const std::vector<std::string> lines = code_lines(source);
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (lines[i].find("catch (") != std::string::npos) found.push_back(place(source, i));
  }
  return found;
}

}  // namespace deflect::house
