#include "msa/base/files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <thread>
#include <vector>

#include "msa/base/error.h"
#include "msa/base/part_file.h"

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
  const std::string new_folder = refusal([&] { write_text(folder / "new" / "", "z"); });
  EXPECT_NE(new_folder.find("new/: cannot be written (it is a folder, a file is wanted)"), new_folder.npos)
      << new_folder;
  EXPECT_EQ(read_text(folder / "x"), "text");
  EXPECT_EQ(names(), 2u);
}

mode_t mode_of(const fs::path& path) {
  struct stat status {};
  EXPECT_EQ(::stat(path.c_str(), &status), 0);
  return status.st_mode & 07777;
}

TEST_F(Files, AFileKeepsItsModeAndANewOneHasWhatTheUmaskLeaves) {
  const mode_t before = ::umask(027);
  for (const mode_t mode : {0600, 0640, 0755}) {
    write_text(folder / "x", "old");
    ASSERT_EQ(::chmod((folder / "x").c_str(), mode), 0);
    write_text(folder / "x", "new");
    EXPECT_EQ(mode_of(folder / "x"), mode);
  }
  write_text(folder / "fresh", "text");
  ::umask(before);
  EXPECT_EQ(mode_of(folder / "fresh"), 0640u);
}

TEST_F(Files, AReadOnlyFileIsRefusedAndStays) {
  write_text(folder / "x", "old");
  ASSERT_EQ(::chmod((folder / "x").c_str(), 0444), 0);
  const std::string message = refusal([&] { write_text(folder / "x", "new"); });
  EXPECT_NE(message.find("x: cannot be written (it is read-only: make it writable"), message.npos) << message;
  EXPECT_EQ(read_text(folder / "x"), "old");
  EXPECT_EQ(names(), 1u);
}

TEST_F(Files, AFolderThatTakesNothingIsNamedWithTheReason) {
  fs::create_directories(folder / "closed");
  write_text(folder / "closed" / "old", "old");
  fs::permissions(folder, fs::perms{0755});
  fs::permissions(folder / "closed", fs::perms{0555});
  fs::permissions(folder / "closed" / "old", fs::perms{0666});
  const bool root = ::geteuid() == 0;
  ASSERT_EQ(root ? ::seteuid(65534) : 0, 0);  // nothing is closed to root
  const auto file = refusal([&] { write_text(folder / "closed" / "x", "text"); });
  const auto below = refusal([&] { write_text(folder / "closed" / "a" / "b" / "x", "text"); });
  const auto before = refusal([&] { require_writable_file(folder / "closed" / "x"); });
  const auto result = refusal([&] { require_writable_folder(folder / "closed" / "out"); });
  EXPECT_NO_THROW(require_writable_file(folder / "closed" / "old"));
  EXPECT_NO_THROW(require_writable_file("/dev/null"));
  ASSERT_EQ(root ? ::seteuid(0) : 0, 0);
  const std::string closed = (folder / "closed").string(), why = closed + ": Permission denied; name another";
  EXPECT_EQ(file.find(closed + "/x: cannot be written (no file can be made in the folder " + why), 0u) << file;
  EXPECT_EQ(below.find(closed + "/a/b/x: cannot be written (no folder can be made in the folder " + why), 0u) << below;
  EXPECT_EQ(before, file);
  EXPECT_EQ(result.find(closed + "/out: cannot be written (no folder can be made in the folder " + why), 0u) << result;
  write_text(folder / "x", "text");
  EXPECT_NE(refusal([&] { require_writable_folder(folder / "x"); }).find("/x is no folder"), std::string::npos);
}

TEST_F(Files, LinksAreFollowed) {
  fs::create_directories(folder / "far");
  write_text(folder / "far" / "x", "old");
  fs::create_symlink("far/x", folder / "near");
  fs::create_symlink(folder / "near", folder / "nearer");
  write_text(folder / "nearer", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "near"));
  EXPECT_TRUE(fs::is_symlink(folder / "nearer"));
  EXPECT_EQ(read_text(folder / "far" / "x"), "new");
  fs::create_symlink("far/none", folder / "dangling");
  write_text(folder / "dangling", "made");
  EXPECT_TRUE(fs::is_symlink(folder / "dangling"));
  EXPECT_EQ(read_text(folder / "far" / "none"), "made");
  fs::create_symlink("round", folder / "round");
  const std::string message = refusal([&] { write_text(folder / "round", "x"); });
  EXPECT_NE(message.find("round: cannot be written (Too many levels"), message.npos) << message;
}

TEST_F(Files, AllNamesOfAFileSeeTheNewText) {
  write_text(folder / "x", "old");
  fs::create_hard_link(folder / "x", folder / "y");
  write_text(folder / "x", "new");
  EXPECT_EQ(read_text(folder / "y"), "new");
  EXPECT_EQ(fs::hard_link_count(folder / "x"), 2u);
}

TEST_F(Files, WhatIsNoRegularFileIsWrittenTo) {
  const fs::path fifo = folder / "fifo";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  std::string seen;
  std::thread reader([&] { seen = read_text(fifo); });
  write_text(fifo, "through");
  reader.join();
  EXPECT_EQ(seen, "through");
  EXPECT_TRUE(fs::is_fifo(fifo));
  EXPECT_EQ(names(), 1u);

  fs::create_symlink("/dev/null", folder / "null");
  write_text(folder / "null", "gone");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_TRUE(fs::is_symlink(folder / "null"));
  const std::string full = refusal([] { write_text("/dev/full", "x"); });
  EXPECT_NE(full.find("/dev/full: cannot be written (No space left"), full.npos) << full;
}

TEST_F(Files, ATextThatALibraryWritesComesFromAFileBesideOrOfItsOwn) {
  for (const fs::path& target : {folder / "x.msh", fs::path("/dev/null")}) {
    fs::path used;
    const std::string text = text_written_by(target, ".msh", [&](const fs::path& part) {
      EXPECT_EQ(part.extension(), ".msh");
      std::ofstream(used = part) << "mesh";
    });
    EXPECT_EQ(text, "mesh");
    EXPECT_EQ(used.parent_path() == folder, target.parent_path() == folder);
    EXPECT_FALSE(fs::exists(used));
  }
  EXPECT_EQ(names(), 0u);
}

/// A process that has ended and been waited for: its number is free.
pid_t ended_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return child;
}

TEST_F(Files, PartFilesOfKilledRunsGoAndThoseOfLivingOnesStay) {
  const auto part = [&](const std::string& of, pid_t process, const std::string& suffix = "") {
    const fs::path path = folder / (of + ".part" + std::to_string(process) + suffix);
    std::ofstream(path) << "half";
    return path;
  };
  const pid_t dead = ended_process();
  const std::vector<fs::path> left = {part("x.csv", dead), part("x.csv", dead, ".msh"), part("x.csv", ::getpid())};
  const std::vector<fs::path> kept = {part("x.csv", ::getppid()), part("y.csv", dead), part("x.csv", dead, ".old.tar"),
                                      folder / "x.csv.party"};
  std::ofstream(kept.back()) << "somebody's";
  const PartFile locked(folder / "x.csv");
  write_text(folder / "x.csv", "whole");
  EXPECT_EQ(read_text(folder / "x.csv"), "whole");
  for (const fs::path& path : left) EXPECT_TRUE(!fs::exists(path) || path == locked.path()) << path;
  for (const fs::path& path : kept) EXPECT_TRUE(fs::exists(path)) << path;
  EXPECT_TRUE(fs::exists(locked.path())) << "a lock says that its run is alive";
}

TEST_F(Files, ManyThreadsWriteOneFileAndOneOfTheirTextsIsThere) {
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&, i] {
      for (int k = 0; k < 500; ++k) write_text(folder / "x", std::string(5000, static_cast<char>('a' + i)));
    });
  for (std::thread& t : threads) t.join();
  const std::string text = read_text(folder / "x");
  EXPECT_EQ(text, std::string(5000, text.front()));
  EXPECT_EQ(names(), 1u);
}

TEST(SafeFileName, LeadsOutOfNoFolder) {
  EXPECT_EQ(safe_file_name("my arm-2_b.c"), "my arm-2_b.c");
  EXPECT_EQ(safe_file_name("Prüfstand"), "Prüfstand");
  for (const char* bad : {"../../x", "/etc/passwd", "..", ".", "", "a/b", "a\nb", "a\\b", ".hidden"}) {
    const std::string name = safe_file_name(bad);
    EXPECT_FALSE(name.empty());
    EXPECT_NE(name.front(), '.') << bad;
    EXPECT_EQ(name.find_first_of("/\\\n"), name.npos) << bad;
  }
  const std::string cut = safe_file_name(std::string(199, 'a') + "üb");
  EXPECT_EQ(cut, std::string(199, 'a')) << "cut before the letter of two bytes";
}

}  // namespace
}  // namespace deflect
