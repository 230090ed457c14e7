// The rules on this tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

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
  for (const char* room : {"msa/base", "msa/mechanism", "msa/frame", "analytic", "meshes", "validation", "tests"})
    EXPECT_TRUE(std::any_of(sources.begin(), sources.end(), [&](const Source& s) { return room_of(s.path) == room; }))
        << "nothing was read in " << room;
  EXPECT_EQ(lines(include_violations(sources)), "");
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

TEST(Tree, TopLevelIsFixed) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(root)) names.push_back(entry.path().filename().string());
  EXPECT_EQ(lines(top_level_violations(names, read_text(root / ".gitignore"))), "");
}

}  // namespace
}  // namespace deflect::house
