// Links between the documents of the tree, as functions of names and texts like the other rules (rules.h).
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "tests/house/rules.h"

namespace deflect::house {

/// A link in Markdown, code left out: "[text](path#anchor)".
struct Link {
  int line = 0;
  std::string
      path;  ///< from the root of the tree, "." for the root; of the document itself where only an anchor stands
  std::string anchor;  ///< without '#'
  std::string written;
};

/// The relative links of a document; addresses with a scheme ("https://…") are none.
std::vector<Link> links_of(const Source& document);

/// Anchors of the headings, as GitHub makes them: in lower case, blanks as hyphens, without punctuation; "-1" and so on
/// behind one that stands twice.
std::set<std::string> anchors_of(const std::string& markdown);

/// "file:line: …" for every relative link whose file does not exist, and for every anchor that is no heading of a
/// document in the list.
std::vector<std::string> link_violations(const std::vector<Source>& documents,
                                         const std::function<bool(const std::string& path)>& exists);

}  // namespace deflect::house
