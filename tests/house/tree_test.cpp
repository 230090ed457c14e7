// The rules on this tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <set>

#include "msa/base/files.h"
#include "tests/house/counts.h"
#include "tests/house/rules.h"
#include "tests/support/paths.h"

namespace deflect::house {
namespace {

namespace fs = std::filesystem;
const fs::path root = test::source_dir();

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

TEST(Tree, NamespacesAreThoseOfTheRooms) {
  EXPECT_EQ(lines(namespace_violations(read_sources(root, {".h", ".cpp"}))), "");
}

TEST(Tree, RoomsLookDownOnlyAndAreSmall) {
  EXPECT_EQ(lines(table_violations()), "");
  EXPECT_EQ(lines(crowded_rooms(read_sources(root, {".cpp"}), 20)), "");
}

TEST(Tree, WhatIsComparedIsASubject) {
  const std::vector<Source> sources = read_sources(root, {".h", ".cpp"});
  EXPECT_EQ(lines(named_in(sources,
                           {"validation/statistics", "validation/compare", "validation/diagnosis", "validation/report",
                            "validation/result_files", "validation/page"},
                           {"Mechanism", "Configuration"})),
            "");
}

/// Rows of a table, in the form of a function.
const std::vector<std::string> tables = {"msa/base/units.cpp: table()", "validation/matrix/mistakes.cpp: table()",
                                         "validation/result_files/result_kinds.cpp: result_kinds()"};

TEST(Tree, FunctionsHaveAtMost60Lines) {
  std::vector<Source> sources = read_sources(root, {".h", ".cpp"});
  std::erase_if(sources, [](const Source& s) { return s.path.starts_with("tests/"); });
  EXPECT_EQ(lines(long_functions(sources, 60, tables)), "");
}

TEST(Tree, IndicesAreCastInOnePlace) {
  std::vector<Source> sources = read_sources(root, {".h", ".cpp"});
  std::erase_if(sources, [](const Source& s) { return s.path.starts_with("tests/"); });
  EXPECT_LT(index_casts(sources), 150);
}

// An error ends the work. It becomes a value in outcome.h alone; beside that it is caught at the borders of libraries
// and where the program ends.
TEST(Tree, ErrorsAreCaughtWhereThereIsAReason) {
  const std::set<std::string> where = {
      "msa/base/outcome.h",                 // errors become values, are told with their place, and change threads
      "msa/base/ending.cpp",                // the end of a program or of one of its processes
      "msa/fields/yaml_reader.cpp",         // the border of yaml-cpp: a line for what it says
      "validation/json/json_text.cpp",      // the border of JSON: likewise
      "msa/base/files.cpp",                 // the border of the file system: what the system said
      "meshes/gmsh_module.cpp",             // the border of Gmsh, which throws texts: nothing leaves a module
      "validation/parallel/mpi_ranks.cpp",  // the border of MPI: nothing leaves a module
      "validation/python/errors.cpp",       // the border of Python: exceptions by kind
      "validation/cli/motions.cpp",         // what cannot stand is drawn before it is refused
      "validation/cli/main.cpp"};           // the border of CLI11: its errors are usage
  std::vector<Source> sources = read_sources(root, {".h", ".cpp"});
  std::erase_if(sources, [&](const Source& s) { return s.path.starts_with("tests/") || where.contains(s.path); });
  EXPECT_EQ(lines(catches(sources)), "");
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
