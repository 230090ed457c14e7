// One HTML page that explains a result: text, script, style and data in a single file, no network wanted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/compare/comparison.h"
#include "validation/json/json_text.h"

namespace deflect::page {

/// A file as it was used, for who wants to repeat the result.
struct PageSource {
  std::string name, text;
};

/// A result as its command writes it with --json.
struct PageResult {
  std::string origin;  ///< command or file
  std::string json;
};

struct PageContents {
  std::string version, command;  ///< of the program; what was typed
  std::optional<PageSource> device, data;
  std::vector<PageResult> results;
  /// Versions of the device against the same data, the first as it was given; may be empty.
  std::vector<const compare::Comparison*> versions;
  Json scene;  ///< page_scene.h; null without
};

/// Whether this program was built with pages.
bool pages_are_built();

/// {"version", "made_with", "command", "device", "data", "results": [{"kind", "origin", "result"}], "versions":
/// [page_residuals.h], "scene"}. A source of more than 0.6 MB is named but not held; of more than
/// 3000 readings the first are held, in all versions together; of a map the arrays that are shown; of a frame's lists
/// the first 4000 rows in all load cases together, with "left_out" beside them. InputError naming
/// the origin of a result that is not JSON or of no kind that a page can show.
Json page_json(const PageContents&);

/// The page. Text of users stands in it as data and never as markup. InputError where pages are not built.
std::string page_html(const PageContents&);

}  // namespace deflect::page
