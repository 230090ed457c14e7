// The documents of the tree: how long they are, and what they point to.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>

#include "msa/base/files.h"
#include "tests/house/links.h"
#include "tests/support/paths.h"

namespace deflect::house {
namespace {

namespace fs = std::filesystem;
using Messages = std::vector<std::string>;
const fs::path root = test::source_dir();

bool in_made_up_tree(const std::string& path) {
  return path == "README.md" || path == "a/README.md" || path == "a/b" || path == "a/b/picture.png";
}

std::string judge(const std::string& text) {
  const Messages messages =
      link_violations({{"README.md", "# Top\n## See: `this` & that\n"}, {"a/README.md", text}}, in_made_up_tree);
  return messages.empty() ? "" : messages.front();
}

TEST(Links, FilesFoldersAndHeadingsAreFound) {
  for (const char* text : {"[x](../README.md)", "[x](b)", "[x](b/)", "![x](b/picture.png)", "[`x`](../README.md#top)",
                           "[x](../README.md#see-this--that)", "# Own\n[x](#own)", "[x](https://example.org/#y)"})
    EXPECT_EQ(judge(text), "") << text;
}

TEST(Links, WhatIsNotThereIsNamedWithFileAndLine) {
  EXPECT_EQ(judge("\n[x](b) [y](c.md)"), "a/README.md:2: link to c.md: there is no a/c.md");
  EXPECT_EQ(judge("[x](../README.md#tip)"), "a/README.md:1: link to ../README.md#tip: README.md has no heading 'tip'");
  EXPECT_EQ(judge("[x](#own)"), "a/README.md:1: link to #own: a/README.md has no heading 'own'");
  EXPECT_EQ(judge("[x](../../README.md)"), "a/README.md:1: link to ../../README.md: there is no ../README.md");
}

TEST(Links, CodeHasNone) {
  EXPECT_EQ(judge("`a[1](x)` is code\n```\n[x](y)\n# No heading\n```\n"), "");
  EXPECT_NE(judge("```\n# Own\n```\n[x](#own)"), "");
}

TEST(Links, AHeadingThatStandsTwiceHasTwoAnchors) {
  EXPECT_EQ(anchors_of("# A b\n## A b\n### C, d\n"), (std::set<std::string>{"a-b", "a-b-1", "c-d"}));
}

std::vector<Source> documents() {
  std::vector<Source> all = read_sources(root, {".md"});
  all.push_back({"README.md", read_text(root / "README.md")});
  return all;
}

TEST(Documents, LinksPointToFilesAndHeadingsThatAreThere) {
  std::string text;
  for (const std::string& message :
       link_violations(documents(), [](const auto& path) { return fs::exists(root / path); }))
    text += message + "\n";
  EXPECT_EQ(text, "");
}

TEST(Documents, TheReadmeHasAtMost150LinesAndLeadsToAllOthers) {
  const Source readme{"README.md", read_text(root / "README.md")};
  EXPECT_EQ(length_violations({readme}, 150), Messages());
  const std::vector<Link> links = links_of(readme);
  for (const Source& document : documents())
    EXPECT_TRUE(document.path == readme.path ||
                std::any_of(links.begin(), links.end(), [&](const Link& link) { return link.path == document.path; }))
        << "README.md has no link to " << document.path;
}

TEST(Documents, TheReadmeNamesThePackagesThatAreInstalled) {
  const std::string readme = read_text(root / "README.md"), prepare = read_text(root / "validation/prepare");
  const std::regex list(R"(_packages=\(([^)]*)\))"), word(R"([^\s"]+)");
  int packages = 0;
  for (std::sregex_iterator at(prepare.begin(), prepare.end(), list), end; at != end; ++at) {
    const std::string names = (*at)[1];
    for (std::sregex_iterator name(names.begin(), names.end(), word); name != end; ++name) {
      if (name->str().starts_with('$')) continue;
      EXPECT_NE(readme.find(" " + name->str()), readme.npos) << name->str();
      ++packages;
    }
  }
  EXPECT_GT(packages, 20);
}

}  // namespace
}  // namespace deflect::house
