// What is written as YAML reads back as the same, wherever it stands.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "msa/fields/yaml_tree.h"

namespace deflect {
namespace {

YamlNode scalar(const std::string& text) {
  YamlNode out;
  out.kind = YamlNode::Kind::scalar;
  out.text = text;
  return out;
}

YamlNode list_of(const std::vector<YamlNode>& items) {
  YamlNode out;
  out.kind = YamlNode::Kind::list;
  out.children = items;
  return out;
}

YamlNode map_of(const std::string& key, const YamlNode& value) {
  YamlNode out;
  out.kind = YamlNode::Kind::map;
  out.add(key, value);
  return out;
}

/// All printable characters before, within and behind a word, and every pair of those that mean something in YAML.
std::vector<std::string> texts() {
  std::vector<std::string> out;
  for (char c = ' '; c < 0x7f; ++c)
    for (const std::string& with : {std::string{c} + "b", std::string("a") + c + "b", std::string("a") + c,
                                    std::string("a ") + c + " b", std::string("a ") + c + "b", std::string{c}})
      out.push_back(with);
  for (const char first : std::string(",?:-#[]{}!&*|>'\"%@`~=<\\ "))
    for (const char second : std::string(",?:-#[]{}!&*|>'\"%@`~=<\\ "))
      out.push_back(std::string("a") + first + second + "b");
  return out;
}

TEST(YamlWriter, ATextReadsBackWhereverItStands) {
  for (const std::string& text : texts()) {
    const YamlNode value = scalar(text);
    const YamlNode written = [&] {
      YamlNode all = map_of("block", value);
      all.add("list", list_of({value, value}));
      all.add("maps", list_of({map_of("x", value), map_of("x", list_of({value}))}));
      return all;
    }();
    const YamlNode read = parse_yaml(block_yaml(written), "file");
    EXPECT_EQ(read.child("block")->text, text);
    ASSERT_EQ(read.child("list")->children.size(), 2U) << text;
    EXPECT_EQ(read.child("list")->children[1].text, text);
    EXPECT_EQ(read.child("maps")->children[0].child("x")->text, text);
    EXPECT_EQ(read.child("maps")->children[1].child("x")->children[0].text, text);
  }
}

/// YAML 1.2.2, 5.7: \N is U+0085, \_ is U+00A0; yaml-cpp 0.7 gives the bytes 0x85 and 0xa0 for them.
TEST(YamlWriter, EscapesAreReadAsUtf8) {
  const YamlNode read = parse_yaml(R"("k\_\N": "a\_b\Nc\u00e9\L\x41ä")", "file");
  EXPECT_EQ(read.keys, std::vector<std::string>{"k\xc2\xa0\xc2\x85"});
  EXPECT_EQ(read.children[0].text,
            "a\xc2\xa0"
            "b\xc2\x85"
            "c\xc3\xa9\xe2\x80\xa8"
            "A\xc3\xa4");
  EXPECT_EQ(parse_yaml(block_yaml(read), "file").children[0].text, read.children[0].text);
}

}  // namespace
}  // namespace deflect
