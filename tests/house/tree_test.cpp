// The rules on this tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <set>

#include "msa/base/files.h"
#include "tests/house/rules.h"

namespace deflect::house {
namespace {

namespace fs = std::filesystem;
const fs::path root = DEFLECT_SOURCE_DIR;

std::string lines(const std::vector<std::string>& messages) {
  std::string text;
  for (const std::string& message : messages) text += message + "\n";
  return text;
}

TEST(Tree, IncludesKeepToTheTableOfRooms) {
  const std::vector<Source> sources = read_sources(root, {".h", ".cpp"});
  for (const char* room :
       {"msa/base", "msa/mechanism", "msa/frame/structure", "analytic", "meshes", "validation/compare", "tests"})
    EXPECT_TRUE(std::any_of(sources.begin(), sources.end(), [&](const Source& s) { return room_of(s.path) == room; }))
        << "nothing was read in " << room;
  EXPECT_EQ(lines(include_violations(sources)), "");
}

TEST(Tree, RoomsLookDownOnlyAndAreSmall) {
  EXPECT_EQ(lines(table_violations()), "");
  EXPECT_EQ(lines(crowded_rooms(read_sources(root, {".cpp"}), 20)), "");
}

TEST(Tree, SourcesAreCppAndHAndLiveInRooms) {
  for (const Source& source : read_sources(root, {".cc", ".cxx", ".c", ".hpp", ".hh", ".hxx", ".ipp", ".inl"}))
    ADD_FAILURE() << source.path << ": sources are called .cpp and .h, so that the other rules see them";
  for (const Source& source : read_sources(root, {".h", ".cpp"}))
    EXPECT_NE(room_of(source.path), "") << source.path << ": in no room of the table";
}

TEST(Tree, SourcesHaveAtMost400Lines) {
  const auto sources = read_sources(root, {".h", ".cpp", ".js", ".css", ".py", ".sh", ".cmake"});
  EXPECT_EQ(lines(length_violations(sources, 400)), "");
}

/// Names at the top level of what git tracks, so that what a user leaves in the checkout is not judged; of the folder
/// where git does not answer.
std::vector<std::string> top_level() {
  std::set<std::string> names;
  if (FILE* pipe = ::popen(("git -C '" + root.string() + "' ls-files 2>/dev/null").c_str(), "r")) {
    char line[4096];
    while (std::fgets(line, sizeof line, pipe)) names.insert(std::string(line, std::strcspn(line, "/\n")));
    ::pclose(pipe);
  }
  if (names.empty())
    for (const auto& entry : fs::directory_iterator(root)) names.insert(entry.path().filename().string());
  return {names.begin(), names.end()};
}

TEST(Tree, TopLevelIsFixed) {
  const std::vector<std::string> names = top_level();
  EXPECT_NE(std::find(names.begin(), names.end(), "README.md"), names.end());
  EXPECT_EQ(lines(top_level_violations(names, read_text(root / ".gitignore"))), "");
}

}  // namespace
}  // namespace deflect::house
