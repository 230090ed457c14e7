// The short way to read plain YAML gives the library's tree, or none.
#include "msa/fields/plain_yaml.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "msa/base/files.h"
#include "tests/support/paths.h"

namespace deflect {
namespace {

void expect_same(const YamlNode& a, const YamlNode& b, const std::string& where) {
  EXPECT_EQ(a.kind, b.kind) << where;
  EXPECT_EQ(a.text, b.text) << where;
  EXPECT_EQ(a.keys, b.keys) << where;
  EXPECT_EQ(a.line, b.line) << where;
  EXPECT_EQ(a.key_line, b.key_line) << where;
  EXPECT_EQ(a.ours, b.ours) << where;
  EXPECT_EQ(a.quoted, b.quoted) << where;
  ASSERT_EQ(a.children.size(), b.children.size()) << where;
  for (std::size_t i = 0; i < a.children.size(); ++i)
    expect_same(a.children[i], b.children[i], where + "." + (i < a.keys.size() ? a.keys[i] : std::to_string(i)));
}

/// Whether the short way takes it; then it gives the library's tree.
bool taken(const std::string& text) {
  const std::optional<YamlNode> plain = parse_plain_yaml(text);
  if (plain) expect_same(*plain, parse_any_yaml(text, "text"), text.substr(0, 60));
  return plain.has_value();
}

TEST(PlainYaml, TakesWhatLongFilesAreMadeOf) {
  for (const char* text : {
           "a: 1\n",
           "a: 1",
           "a: 1   \n\n# comment ä: {[\nb: two words  \n",
           "\n\n# first\nname: x\nnodes:\n\n  n1: [0 mm, -1.5e3 mm, +2 mm]\n  n2: [ .5 m ,1 m,2 m ]\n",
           "a:\n  b:\n    c: {d: [e, {f: 1 N/mm^2}], g: {}}\n  h: []\nk: lbf*in/rad\n",
           "members:\n  m 1: {from: a-1, to: b_2}\n  2: {from: b, to: 10 %}\nloads:\n    x: 1\n",
           "a: {b : 1, c:  2 }\nd : x\n",
           "a: yes\nb: 010\nc: 1 = 2 (3) <4>\n",
       })
    EXPECT_TRUE(taken(text)) << text;
}

TEST(PlainYaml, LeavesEverythingElseToTheLibrary) {
  for (const char* text : {
           "",
           "\n",
           "# nothing\n",
           "a",
           "- a\n",
           "[a, b]\n",
           "{a: 1}\n",
           " a: 1\n",
           "---\na: 1\n",
           "a: 1\n...\n",
           "a: 1\na: 2\n",
           "a: {b: 1, b: 2}\n",
           "a:\n",
           "a:\nb: 1\n",
           "a: null\n",
           "a: ~\n",
           "a: {b: NULL}\n",
           "a: 'x'\n",
           "a: \"x\"\n",
           "a: !ours 1\n",
           "a: &x 1\n",
           "a: *x\n",
           "a: |\n  text\n",
           "a: >\n  text\n",
           "a: 1 # comment\n",
           "a: x\n  y\n",
           "a: {b: 1,\n  c: 2}\n",
           "a:\n  - 1\n  - 2\n",
           "a: [1, 2,]\n",
           "a: {b}\n",
           "a: {b:1}\n",
           "a: {b: }\n",
           "a: [1, , 2]\n",
           "a:1\n",
           "a: b: c\n",
           "a: [1, 2\n",
           "a: 1]\n",
           "a: {b: 1}}\n",
           "a:\n   b: 1\n  c: 2\n",
           "a: 1\n b: 2\n",
           "a:\tb\n",
           "\ta: b\n",
           "a: 1\r\nb: 2\r\n",
           "a: \xc3\xa4\n",
           "? a\n: b\n",
           "a: @b\n",
           "a: - b\n",
           "<<: {a: 1}\n",
           "%YAML 1.2\n---\na: 1\n",
           "a: ...\n",
           "a: -\n",
           "a: {b: -}\n",
           "a: [b: 1]\n",
           "a: [[1, 2], 3\nb: 1\n",
           "null: 1\n",
       })
    EXPECT_FALSE(taken(text)) << text;
  EXPECT_FALSE(taken("a: " + std::string(30, '[') + std::string(30, ']') + "\n"));
}

TEST(PlainYaml, GivesTheLibrarysTreeOfEveryFileOfTheProgram) {
  int files = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::filesystem::path(test::source_dir()) / "validation"))
    if (entry.path().extension() == ".yaml") {
      taken(read_text(entry.path()));
      ++files;
    }
  EXPECT_GT(files, 10);
}

}  // namespace
}  // namespace deflect
