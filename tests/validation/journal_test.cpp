// Finished parts in a file: what is taken from it is what was kept, whatever became of its end.
#include "validation/parallel/journal.h"

#include <gtest/gtest.h>

#include <atomic>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/outcome.h"
#include "tests/support/program.h"
#include "tests/support/thread_ranks.h"
#include "validation/parallel/pack.h"

namespace deflect::parallel {
namespace {

/// Case i gives a text of i mod 40 letters; counts how often it worked.
struct Texts {
  explicit Texts(std::size_t n) : values(n) {
    cases.count = n;
    cases.work = [this](std::size_t i) {
      values[i] = wanted(i);
      ++worked;
    };
    cases.result = [this](std::size_t i) { return pack(values[i]); };
    cases.take = [this](std::size_t i, const std::string& bytes) { values[i] = unpack<std::string>(bytes); };
  }
  static std::string wanted(std::size_t i) { return std::string(i % 40, static_cast<char>('a' + i % 26)); }
  bool whole() const {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (values[i] != wanted(i)) return false;
    return true;
  }

  std::vector<std::string> values;
  std::atomic<std::size_t> worked = 0;
  SharedCases cases;
};

class JournalFile : public ::testing::Test {
 protected:
  std::string text() { return read_text(file()); }
  std::filesystem::path file() { return folder / "journal"; }

  /// Works through n cases; how many of them had to be worked on.
  std::size_t worked(std::size_t n, const std::string& head = "work\n") {
    Texts texts(n);
    Journal journal(file(), head);
    for_each_case(texts.cases, &journal, 0, nullptr, 2);
    EXPECT_TRUE(texts.whole());
    return texts.worked;
  }

  test::Folder folder;
};

TEST_F(JournalFile, TakesWhatWasKept) {
  EXPECT_EQ(worked(50), 50u);
  EXPECT_EQ(worked(50), 0u);
  EXPECT_EQ(worked(60), 10u);
}

TEST_F(JournalFile, CutAtAnyByteLosesOnlyWhatStandsBehind) {
  worked(8);
  const std::string all = text();
  std::size_t before = 8;
  for (std::size_t length = 0; length <= all.size(); ++length) {
    write_text(file(), all.substr(0, length));
    const std::size_t again = worked(8);
    EXPECT_LE(again, before) << length;
    before = again;
    EXPECT_EQ(worked(8), 0u) << length;  // what was added behind the cut is found
  }
  EXPECT_EQ(before, 0u);
}

TEST_F(JournalFile, AChangedByteIsSeen) {
  worked(8);
  const std::string all = text();
  for (std::size_t at = 0; at < all.size(); ++at) {
    std::string changed = all;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    write_text(file(), changed);
    Texts texts(8);
    try {
      Journal journal(file(), "work\n");
      for_each_case(texts.cases, &journal, 0, nullptr, 1);
      EXPECT_TRUE(texts.whole()) << at;
      EXPECT_GT(texts.worked, 0u) << at;
    } catch (const InputError&) {
      EXPECT_LT(at, 40u);  // of the kind of file
    }
  }
}

TEST_F(JournalFile, OtherWorkIsRefused) {
  worked(3, "program 1\ncommand map\n");
  const std::string before = text();
  const std::string said = outcome_of<InputError>([&] { return worked(3, "program 1\ncommand solve\n"); }).why;
  EXPECT_NE(said.find("it has 'command map', this run 'command solve'"), std::string::npos) << said;
  EXPECT_EQ(text(), before);
  EXPECT_EQ(worked(3, "program 1\ncommand map\n"), 0u);
}

TEST_F(JournalFile, AnotherFileIsRefusedAndStays) {
  for (const std::string mine : {"my measurements", "deflect journal 2\n"}) {
    write_text(file(), mine);
    EXPECT_THROW(worked(3), InputError);
    EXPECT_EQ(text(), mine);
  }
  EXPECT_THROW(Journal("/dev/null", ""), InputError);
  EXPECT_THROW(Journal(folder / ".", ""), InputError);
}

TEST_F(JournalFile, OneRunAtATime) {
  Journal first(file(), "");
  EXPECT_THROW(Journal(file(), ""), InputError);
}

TEST_F(JournalFile, IsGoneInTheEnd) {
  Journal journal(file(), "");
  journal.remove();
  EXPECT_FALSE(std::filesystem::exists(file()));
}

TEST_F(JournalFile, NumbersKeepPartsOfTheWorkApart) {
  for (const std::size_t again : {4u, 0u}) {
    Texts first(4), second(4);
    Journal journal(file(), "");
    for_each_case(first.cases, &journal, 100, nullptr, 1);
    for_each_case(second.cases, &journal, 200, nullptr, 1);
    EXPECT_TRUE(first.whole() && second.whole());
    EXPECT_EQ(first.worked, again);
    EXPECT_EQ(second.worked, again);
  }
}

TEST_F(JournalFile, RanksGoOnTogether) {
  constexpr std::size_t count = 200;
  worked(count);
  const std::string all = text();
  for (const int size : {1, 2, 3}) {
    write_text(file(), all.substr(0, all.size() / 2));
    std::atomic<std::size_t> worked_on = 0, told = 0;
    for (const Ending& end : test::ThreadRanks(size).run([&](Ranks& ranks) {
           Texts texts(count);
           Journal journal(file(), "work\n", &ranks);
           for_each_case(texts.cases, &journal, 0, &ranks, 2, [&](std::size_t done) {
             if (ranks.first() && done > told) told = done;
           });
           worked_on += texts.worked;
           EXPECT_TRUE(!ranks.first() || texts.whole());
         }))
      EXPECT_EQ(end.code, 0) << end.message;
    EXPECT_GT(worked_on, 0u);
    EXPECT_LT(worked_on, count);
    EXPECT_EQ(told, count);
    EXPECT_EQ(worked(count), 0u);
  }
}

}  // namespace
}  // namespace deflect::parallel
