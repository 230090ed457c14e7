#include "tests/house/links.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>

namespace deflect::house {
namespace {

/// Calls visit(line number, line) for the lines outside fenced code, their code spans left out where asked.
template <class Visit>
void for_each_line(const std::string& markdown, bool with_spans, const Visit& visit) {
  static const std::regex span("`[^`]*`");
  std::istringstream lines(markdown);
  bool code = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with("```"))
      code = !code;
    else if (!code)
      visit(number, with_spans ? line : std::regex_replace(line, span, ""));
  }
}

std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : heading) {
    const bool upper = c >= 'A' && c <= 'Z';
    const bool kept = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || (c & 0x80);
    if (c == ' ')
      anchor += '-';
    else if (upper || kept)
      anchor += static_cast<char>(upper ? c - 'A' + 'a' : c);
  }
  return anchor;
}

}  // namespace

std::vector<Link> links_of(const Source& document) {
  static const std::regex link(R"(\]\(([^)\s]+)\))"), scheme("[a-z]+:.*");
  const std::filesystem::path folder = std::filesystem::path(document.path).parent_path();
  std::vector<Link> links;
  for_each_line(document.text, false, [&](int number, const std::string& line) {
    for (std::sregex_iterator at(line.begin(), line.end(), link), end; at != end; ++at) {
      const std::string written = (*at)[1];
      if (std::regex_match(written, scheme)) continue;
      const std::size_t hash = std::min(written.find('#'), written.size());
      std::string path = document.path;
      if (hash > 0) path = (folder / written.substr(0, hash)).lexically_normal().generic_string();
      if (path.size() > 1 && path.ends_with('/')) path.pop_back();
      links.push_back({number, path, hash < written.size() ? written.substr(hash + 1) : "", written});
    }
  });
  return links;
}

std::set<std::string> anchors_of(const std::string& markdown) {
  static const std::regex heading("#{1,6} +(.*)");
  std::set<std::string> anchors;
  std::map<std::string, int> seen;
  for_each_line(markdown, true, [&](int, const std::string& line) {
    std::smatch match;
    if (!std::regex_match(line, match, heading)) return;
    const std::string anchor = anchor_of(match[1]);
    const int before = seen[anchor]++;
    anchors.insert(before == 0 ? anchor : anchor + "-" + std::to_string(before));
  });
  return anchors;
}

std::vector<std::string> link_violations(const std::vector<Source>& documents,
                                         const std::function<bool(const std::string& path)>& exists) {
  std::vector<std::string> violations;
  for (const Source& document : documents)
    for (const Link& link : links_of(document)) {
      const auto refuse = [&](const std::string& what) {
        violations.push_back(document.path + ":" + std::to_string(link.line) + ": link to " + link.written + ": " +
                             what);
      };
      if (link.path.starts_with("..") || !exists(link.path)) {
        refuse("there is no " + link.path);
        continue;
      }
      if (link.anchor.empty()) continue;
      const auto target = std::find_if(documents.begin(), documents.end(),
                                       [&](const Source& other) { return other.path == link.path; });
      if (target == documents.end() || !anchors_of(target->text).contains(link.anchor))
        refuse(link.path + " has no heading '" + link.anchor + "'");
    }
  return violations;
}

}  // namespace deflect::house
