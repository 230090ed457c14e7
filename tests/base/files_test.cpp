#include "msa/base/files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "msa/base/error.h"

namespace deflect {
namespace {

namespace fs = std::filesystem;

class Files : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::path(::testing::TempDir()) / ("deflect_files_" + std::string(test->name()));
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  std::size_t names() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
  fs::path folder;
};

template <class F>
std::string refusal(F f) {
  try {
    f();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST_F(Files, EveryByteComesBack) {
  std::string bytes;
  for (int i = 0; i < 256; ++i) bytes += static_cast<char>(i);
  for (const std::string& text : {std::string(), std::string("a\r\nb"), bytes}) {
    write_text(folder / "x", text);
    EXPECT_EQ(read_text(folder / "x"), text);
  }
}

TEST_F(Files, WritingReplacesTheWholeFileAndLeavesNothingBeside) {
  write_text(folder / "x", std::string(100000, 'a'));
  write_text(folder / "x", "b");
  EXPECT_EQ(read_text(folder / "x"), "b");
  EXPECT_EQ(names(), 1u);
}

TEST_F(Files, MissingFoldersAreMade) {
  write_text(folder / "a" / "b" / "x", "text");
  EXPECT_EQ(read_text(folder / "a" / "b" / "x"), "text");
}

TEST_F(Files, WhatCannotBeReadIsNamed) {
  const std::string missing = refusal([&] { read_text(folder / "none"); });
  EXPECT_NE(missing.find((folder / "none").string() + ": cannot be read (No such file"), missing.npos) << missing;
  const std::string is_folder = refusal([&] { read_text(folder); });
  EXPECT_NE(is_folder.find("is a folder"), is_folder.npos) << is_folder;
}

TEST_F(Files, WhatCannotBeWrittenIsNamedAndChangesNothing) {
  write_text(folder / "x", "text");
  const std::string below_a_file = refusal([&] { write_text(folder / "x" / "y", "z"); });
  EXPECT_NE(below_a_file.find("y: cannot be written"), below_a_file.npos) << below_a_file;
  fs::create_directories(folder / "taken" / "by");
  const std::string over_a_folder = refusal([&] { write_text(folder / "taken", "z"); });
  EXPECT_NE(over_a_folder.find("taken: cannot be written"), over_a_folder.npos) << over_a_folder;
  EXPECT_EQ(read_text(folder / "x"), "text");
  EXPECT_EQ(names(), 2u);
}

}  // namespace
}  // namespace deflect
