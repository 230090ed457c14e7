// The rules themselves, on made-up trees that keep and break them.
#include "tests/house/rules.h"
#include "tests/house/counts.h"

#include <gtest/gtest.h>

namespace deflect::house {
namespace {

using Messages = std::vector<std::string>;

/// What is said about a file with one include, in a tree where every room has a header.
std::string judge(const std::string& path, const std::string& include) {
  std::vector<Source> sources = {{path, "#pragma once\n#include " + include + "\n"}};
  for (const char* header : {"msa/base/a.h", "msa/mechanism/a.h", "msa/frame/structure/a.h", "analytic/a.h",
                             "meshes/a.h", "meshes/gmsh.h", "validation/compare/a.h", "tests/support/a.h"})
    if (path != header) sources.push_back({header, ""});
  const Messages messages = include_violations(sources);
  if (messages.size() > 1) ADD_FAILURE() << messages.size() << " messages on one include";
  return messages.empty() ? "" : messages.front();
}

TEST(Rooms, EveryArrowIsJudgedByTheTable) {
  const std::vector<std::string> rooms = {
      "msa/base", "msa/mechanism", "msa/frame/structure", "analytic", "meshes", "validation/report", "tests"};
  // Row: who includes; column: whom, in the order of `rooms`.
  const char* allowed[] = {"+......", "++.....", "+.+....", "++.+...", "++..+..", "+++..+.", "+++++++"};
  for (std::size_t from = 0; from < rooms.size(); ++from)
    for (std::size_t to = 0; to < rooms.size(); ++to) {
      const Messages found = include_violations(
          {{rooms[from] + "/from.cpp", "#include \"" + rooms[to] + "/to.h\"\n"}, {rooms[to] + "/to.h", ""}});
      EXPECT_EQ(found.empty(), allowed[from][to] == '+') << rooms[from] << " -> " << rooms[to];
    }
}

TEST(Rooms, MessageNamesFileLineAndRule) {
  EXPECT_EQ(judge("msa/frame/structure/x.cpp", "\"analytic/a.h\""),
            "msa/frame/structure/x.cpp:2: includes analytic/a.h: msa/frame/structure may include "
            "msa/base, msa/frame/elements");
  EXPECT_EQ(judge("analytic/x.h", "\"msa/frame/structure/a.h\""),
            "analytic/x.h:2: includes msa/frame/structure/a.h: the two theories never include each other: analytic may "
            "include msa/base, msa/mechanism");
  EXPECT_EQ(judge("validation/compare/x.cpp", "\"tests/support/a.h\""),
            "validation/compare/x.cpp:2: includes tests/support/a.h: nothing includes tests");
  EXPECT_EQ(judge("msa/base/x.h", "\"meshes/a.h\""),
            "msa/base/x.h:2: includes meshes/a.h: msa/base may include no other room");
}

TEST(Rooms, AFileInNoRoomMayNotBeUsed) {
  EXPECT_NE(judge("msa/cellar/x.cpp", "\"msa/base/a.h\""), "");
  EXPECT_EQ(include_violations({{"validation/x.cpp", "#include \"msa/cellar/a.h\""}, {"msa/cellar/a.h", ""}}).size(),
            1u);
}

TEST(Includes, AreFullPathsInQuotes) {
  EXPECT_EQ(judge("msa/frame/structure/x.cpp", "\"msa/frame/structure/a.h\""), "");
  EXPECT_NE(judge("msa/frame/structure/x.cpp", "\"a.h\""), "");
  EXPECT_NE(judge("msa/frame/structure/x.cpp", "\"../base/a.h\""), "");
  EXPECT_NE(judge("msa/frame/structure/x.cpp", "\"msa/frame/structure/missing.h\""), "");
  EXPECT_NE(judge("msa/frame/structure/x.cpp", "<msa/frame/structure/a.h>"), "");
  EXPECT_NE(judge("msa/frame/structure/x.cpp", "HEADER"), "");
}

TEST(Includes, AreFoundHoweverTheyAreSpaced) {
  const std::string bad = "\"analytic/a.h\"";
  for (const std::string line : {"#include", "  #include", "#  include", "#\tinclude  ", "# include_next"})
    EXPECT_EQ(include_violations({{"msa/frame/structure/x.cpp", line + bad + " // why"}, {"analytic/a.h", ""}}).size(),
              1u)
        << line;
  EXPECT_TRUE(include_violations({{"msa/frame/structure/x.cpp", "// #include " + bad}, {"analytic/a.h", ""}}).empty());
}

TEST(Includes, ThirdPartyLibrariesKeepTheirPlace) {
  EXPECT_EQ(judge("msa/frame/structure/x.cpp", "<vector>"), "");
  EXPECT_EQ(judge("msa/frame/structure/x.h", "<Eigen/Sparse>"), "");

  EXPECT_EQ(judge("msa/frame/structure/sparse.cpp", "<cholmod.h>"), "");
  EXPECT_NE(judge("msa/frame/structure/sparse.h", "<cholmod.h>"), "");
  EXPECT_NE(judge("analytic/x.cpp", "<cholmod.h>"), "");
  EXPECT_EQ(judge("tests/benchmark/frames/bare_cholmod.cpp", "<cholmod.h>"), "");
  EXPECT_NE(judge("tests/benchmark/frames/x.cpp", "<cholmod.h>"), "");
  EXPECT_NE(judge("analytic/x.cpp", "<Eigen/CholmodSupport>"), "");
  EXPECT_EQ(judge("msa/frame/structure/rank.cpp", "<SuiteSparseQR.hpp>"), "");
  EXPECT_NE(judge("tests/frame/x.cpp", "<SuiteSparseQR.hpp>"), "");

  EXPECT_EQ(judge("meshes/gmsh_lines.cpp", "<gmsh.h>"), "");
  EXPECT_NE(judge("meshes/lines.cpp", "<gmsh.h>"), "");
  EXPECT_NE(judge("meshes/gmsh_lines.h", "<gmsh.h>"), "");
  EXPECT_EQ(judge("meshes/lines.cpp", "\"meshes/gmsh.h\""), "") << "our own header of that name";

  EXPECT_EQ(judge("msa/fields/device_reader.cpp", "<yaml-cpp/yaml.h>"), "");
  EXPECT_EQ(judge("msa/fields/writer.cpp", "<yaml-cpp/yaml.h>"), "");
  EXPECT_NE(judge("msa/fields/reader.h", "<yaml-cpp/yaml.h>"), "");
  EXPECT_NE(judge("msa/mechanism/edit.cpp", "<yaml-cpp/yaml.h>"), "");
  EXPECT_NE(judge("validation/effects/reader.cpp", "<yaml-cpp/yaml.h>"), "");

  EXPECT_EQ(judge("validation/cli/main.cpp", "<CLI/CLI.hpp>"), "");
  EXPECT_NE(judge("validation/report/x.cpp", "<CLI/CLI.hpp>"), "");
  EXPECT_EQ(judge("validation/report/json.cpp", "<nlohmann/json.hpp>"), "");
  EXPECT_NE(judge("msa/mechanism/x.cpp", "<nlohmann/json.hpp>"), "");
  EXPECT_EQ(judge("tests/validation/x.cpp", "<nlohmann/json.hpp>"), "");
  EXPECT_NE(judge("msa/base/x.h", "<gtest/gtest_prod.h>"), "");
}

TEST(Includes, ALibraryOfOneFileIsRefusedInASecond) {
  const std::string use = "#include <cholmod.h>\n";
  EXPECT_TRUE(include_violations({{"msa/frame/structure/a.cpp", use + use}}).empty());
  EXPECT_EQ(include_violations({{"msa/frame/structure/a.cpp", use}, {"msa/frame/structure/b.cpp", "\n\n" + use}}),
            Messages{"msa/frame/structure/b.cpp:3: includes cholmod.h: CHOLMOD belongs into one .cpp file of "
                     "msa/frame/structure, and "
                     "msa/frame/structure/a.cpp includes it already"});
}

TEST(Namespaces, ARoomOfValidationOpensItsOwn) {
  const auto judged = [](const std::string& path, const std::string& text) {
    return namespace_violations({{path, text}});
  };
  EXPECT_TRUE(judged("msa/base/a.h", "namespace deflect {\n}\n").empty());
  EXPECT_TRUE(judged("validation/page/a.h", "namespace deflect::page {\nint a;\n}\n").empty());
  EXPECT_TRUE(judged("validation/page/a.h", "namespace deflect::page::inner {\nint a;\n}\n").empty());
  EXPECT_TRUE(judged("validation/cli/commands/a.cpp", "namespace deflect::cli {\n}\n").empty());
  EXPECT_EQ(judged("validation/page/a.h", "#pragma once\n"),
            Messages{"validation/page/a.h: does not open deflect::page"});
  EXPECT_EQ(judged("validation/page/a.h", "namespace deflect {\nint a;\n}\nnamespace deflect::page {\n}\n"),
            Messages{"validation/page/a.h:1: opens deflect, its own is deflect::page"});
  EXPECT_EQ(judged("validation/page/a.h", "namespace deflect::page {\n}\nnamespace deflect::pages {\nint a;\n}\n"),
            Messages{"validation/page/a.h:3: opens deflect::pages, its own is deflect::page"});
}

TEST(Namespaces, NamesOfOthersMayBeDeclaredAndGivenToAll) {
  const std::string own = "namespace deflect::page {\n}\n";
  EXPECT_TRUE(
      namespace_violations({{"validation/page/a.h", "namespace deflect::scene {\nclass Scene;\n}\n" + own},
                            {"validation/page/b.h", own + "namespace deflect {\n/// Why.\nusing page::Page;\n}\n"}})
          .empty());
}

TEST(Namespaces, HeadersUseNoneAsAWhole) {
  const std::string text = "namespace deflect::page {\nusing namespace scene;\n}\n";
  EXPECT_EQ(namespace_violations({{"validation/page/a.h", text}}),
            Messages{"validation/page/a.h:2: a header uses a whole namespace"});
  EXPECT_TRUE(namespace_violations({{"validation/page/a.cpp", text}}).empty());
}

TEST(Length, CountsAnUnfinishedLastLine) {
  EXPECT_TRUE(length_violations({{"a.h", ""}, {"b.h", "1\n2\n"}}, 2).empty());
  EXPECT_EQ(length_violations({{"a.h", "1\n2\n3"}}, 2), Messages{"a.h: 3 lines, at most 2"});
}

TEST(TopLevel, OnlyFixedHiddenAndIgnoredNames) {
  const std::string gitignore = "/build/\n/build-*/\n\ncompile_commands.json\n";
  EXPECT_TRUE(
      top_level_violations({"msa", "README.md", ".ci", "build", "build-debug", "compile_commands.json"}, gitignore)
          .empty());
  EXPECT_EQ(top_level_violations({"msa", "docs", "builder"}, gitignore),
            (Messages{"docs: does not belong to the top level", "builder: does not belong to the top level"}));
}

TEST(Counts, SeeNamesLongFunctionsCastsAndCatches) {
  const Source source{"validation/compare/x.cpp",
                      "// a Mechanism\nvoid f(const Mechanism& m) {\n  g();\n  try {\n  } catch (...) {\n  }\n}\n"
                      "int i = static_cast<int>(n) + static_cast<double>(n);\n"};
  EXPECT_EQ(named_in({source}, {"validation/compare"}, {"Mechanism"}),
            std::vector<std::string>{"validation/compare/x.cpp:2: names Mechanism"});
  EXPECT_TRUE(named_in({source}, {"validation/page"}, {"Mechanism"}).empty());
  EXPECT_EQ(long_functions({source}, 5, {}), std::vector<std::string>{"validation/compare/x.cpp:2: 6 lines"});
  EXPECT_TRUE(long_functions({source}, 6, {}).empty());
  EXPECT_TRUE(long_functions({source}, 5, {"validation/compare/x.cpp: f("}).empty());
  const Source broken{"validation/compare/y.cpp", "int f(int a,\n      int b) {\n  g();\n  return 0;\n}\n"};
  EXPECT_EQ(long_functions({broken}, 4, {}), std::vector<std::string>{"validation/compare/y.cpp:1: 5 lines"});
  EXPECT_EQ(index_casts({source}), 1);
  EXPECT_EQ(catches({source}), std::vector<std::string>{"validation/compare/x.cpp:5"});
}

}  // namespace
}  // namespace deflect::house
