// The rules of the house as functions of names and texts, so that they can be tried on made-up trees.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace deflect::house {

/// A file of the tree: path from the root with '/', and its bytes.
struct Source {
  std::string path, text;
};

/// The room a file lives in ("msa/base", "analytic", …), empty outside the rooms.
std::string room_of(const std::string& path);

/// One message "file:line: …" for every include that breaks a rule:
/// - the arrow between two rooms is not in the table;
/// - a quoted include is not the full path, from the root, of one of `sources`; an own file stands in <>;
/// - a third-party library is included outside the files it is confined to;
/// - the included name cannot be read off (a macro).
std::vector<std::string> include_violations(const std::vector<Source>& sources);

/// One message for every room of the table that may look into one that stands behind it there.
std::vector<std::string> table_violations();

/// One message "file:line: …" for every namespace that a file of validation/<room> opens and that is not
/// deflect::<room>, for every file that does not open its own, and for every header of any room but `tests` that uses
/// a whole namespace. Names that are only declared, or given to all with `using`, may stand in the namespace of others.
std::vector<std::string> namespace_violations(const std::vector<Source>& sources);

/// "room has n sources" for every room with more than `limit`.
std::vector<std::string> crowded_rooms(const std::vector<Source>& sources, int limit);

/// "file: n lines, at most `limit`" for every longer file.
std::vector<std::string> length_violations(const std::vector<Source>& sources, int limit);

/// Names at the top level that are neither of the fixed ones, nor hidden, nor matched by `gitignore`, whose
/// patterns may begin or end with '/' and end with '*'.
std::vector<std::string> top_level_violations(const std::vector<std::string>& names, const std::string& gitignore);

/// All files with these extensions below the rooms and `tests`, sorted by path.
std::vector<Source> read_sources(const std::filesystem::path& root, const std::vector<std::string>& extensions);

}  // namespace deflect::house
