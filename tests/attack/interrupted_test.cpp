// Work that is interrupted: what a command was writing is whole or not there, and what was there before stays until it
// is. Moments are drawn by the dice; DEFLECT_ATTACK=N draws as many for each command.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>

#include "msa/base/outcome.h"
#include "msa/mechanism/device_file.h"
#include "tests/attack/count.h"
#include "tests/attack/random_frame.h"
#include "tests/support/paths.h"
#include "tests/support/program.h"
#include "validation/json/json_text.h"
#include "validation/measurement/measurements.h"

namespace deflect::attack {
namespace {

constexpr unsigned usual_moments = 4;

struct Work {
  const char* name;
  const char* arguments;
  const char* file;  ///< that it writes
};

constexpr Work works[] = {
    {"solve", "solve haptic-6psu --pose 25,25,198.9 --load 50,0,0 --json out.json", "out.json"},
    {"map", "map haptic-6psu --n 3 --threads 1 --json out.json", "out.json"},
    {"simulate", "simulate 3-rrr --campaign cycle --threads 1 -o out.csv", "out.csv"},
    {"compare", "compare 3-rrr data.csv --threads 1 --json out.json", "out.json"},
    {"diagnose", "diagnose 3-rrr data.csv --bootstrap 99 --threads 1 --json out.json", "out.json"},
    {"add", "add 3-rrr load_gain --set factor=1.1 -o out.yaml", "out.yaml"},
    {"history", "history data.csv 3-rrr 3-rrr --threads 1 --json out.json", "out.json"},
    {"show", "show 3-rrr --report out.html", "out.html"},
};

/// Why the file is not whole; empty where it is.
std::string broken(const std::filesystem::path& file) {
  const std::string text = test::contents(file);
  if (file.extension() == ".json") return outcome_of([&] { return json::parse_json(text, "out", ""); }).why;
  if (file.extension() == ".csv") return outcome_of([&] { return measurement::parse_measurements(text, "out"); }).why;
  if (file.extension() == ".yaml") return outcome_of([&] { return parse_mechanism(text, "out"); }).why;
  return text.find("</html>") == text.npos ? "the page does not end" : "";
}

class Interrupted : public ::testing::TestWithParam<Work> {
 protected:
  void SetUp() override {
    ASSERT_EQ(run("'" + test::program() + "' simulate 3-rrr --campaign paper -o data.csv").code, 0);
  }

  test::Run run(const std::string& line) {
    return test::command(fmt::format("cd '{}' && ( {} )", (folder / ".").string(), line));
  }

  std::size_t files() {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder / "."), std::filesystem::directory_iterator()));
  }

  test::Folder folder;
};

TEST_P(Interrupted, LeavesWholeFilesOrNone) {
  const Work work = GetParam();
  const std::string line = fmt::format("'{}' {}", test::program(), work.arguments);
  const std::filesystem::path file = folder / work.file;
  const auto start = std::chrono::steady_clock::now();
  run(line);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::filesystem::remove(file);
  Dice dice(17);
  const unsigned moments = std::max(usual_moments, count_on_demand());
  for (unsigned i = 0; i < moments; ++i) {
    const bool old = i % 2 == 1;
    if (old) std::ofstream(file) << "what was there before";
    const char* signal = dice.chance(0.5) ? "KILL" : "INT";
    // The last moments matter most: files are written at the end.
    const double at = seconds * (dice.chance(0.5) ? dice.real(0.01, 1) : dice.real(0.8, 1.1));
    run(fmt::format("timeout -s {} {:.3f} {}", signal, at, line));
    const bool there = std::filesystem::exists(file);
    EXPECT_TRUE(there || !old) << work.name << ", " << signal << ": the old file is gone";
    if (!there || test::contents(file) == "what was there before") continue;
    EXPECT_EQ(broken(file), "") << work.name << ", " << signal << " after " << at << " s of " << seconds;
    std::filesystem::remove(file);
  }
}

// A limit of half a kilobyte on every file stands for a disk that is full.
TEST_P(Interrupted, AFullDiskIsToldAndLeavesNothing) {
  const Work work = GetParam();
  const std::string line = fmt::format("trap '' XFSZ; ulimit -f 1; '{}' {}", test::program(), work.arguments);
  const std::filesystem::path file = folder / work.file;
  for (const bool old : {false, true}) {
    if (old) std::ofstream(file) << "what was there before";
    const std::size_t before = files();
    const test::Run r = run(line);
    EXPECT_EQ(files(), before) << work.name;
    if (old) {
      EXPECT_EQ(test::contents(file), "what was there before") << work.name;
    }
    EXPECT_NE(r.out.find("cannot be written (File too large)"), std::string::npos) << work.name << ": " << r.out;
  }
}

/// Work that keeps a journal with --resume; most of its time goes into what it keeps.
constexpr Work long_works[] = {
    {"map", "map tripteron --n 17 --threads 1", "out.json"},
    {"diagnose", "diagnose 3-rrr data.csv --bootstrap 40000 --threads 1", "out.json"},
};

using InterruptedLong = Interrupted;

// Killed again and again, work that keeps a journal goes on where it stood and ends with the same bytes.
TEST_P(InterruptedLong, GoesOnWhereItStood) {
  const auto work = [&](const std::string& before, const char* options) {
    return run(fmt::format("{} '{}' {} {}", before, test::program(), GetParam().arguments, options));
  };
  const test::Run whole = work("", "--json whole.json");
  ASSERT_EQ(whole.code, 0) << whole.out;
  const auto start = std::chrono::steady_clock::now();
  work("", "--resume journal --json kept.json");
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_EQ(test::contents(folder / "kept.json"), test::contents(folder / "whole.json"));
  Dice dice(21);
  const std::filesystem::path journal = folder / "journal", out = folder / GetParam().file;
  const unsigned moments = std::max(usual_moments, count_on_demand());
  unsigned went_on = 0;
  for (unsigned i = 0; i < moments; ++i) {
    std::uintmax_t kept = 0;
    std::string said = "not run";
    for (int tries = 0; !std::filesystem::exists(out) && tries < 200; ++tries) {
      const bool there = std::filesystem::exists(journal);
      const std::uintmax_t size = there ? std::filesystem::file_size(journal) : 0;
      went_on += size > kept && kept > 0;
      kept = size;
      // Early at first, so that it takes several runs however busy the computer is.
      const double at = seconds * (dice.real(0.1, 0.5) + 0.02 * tries);
      const std::string timeout = fmt::format("timeout -s {} {:.3f}", dice.chance(0.5) ? "KILL" : "INT", at);
      said = work(timeout, "--resume journal --json out.json").out;
    }
    ASSERT_TRUE(std::filesystem::exists(out)) << said;
    EXPECT_EQ(test::contents(out), test::contents(folder / "whole.json"));
    work("", "--resume journal --json out.json");  // where it was killed behind its last file
    EXPECT_FALSE(std::filesystem::exists(journal));
    std::filesystem::remove(out);
  }
  EXPECT_GT(went_on, 0u) << "no run was interrupted twice between its first and its last case";
}

TEST(InterruptedMap, IsNotContinuedByAnother) {
  const test::Folder folder;
  const auto map = [&](const char* before, const char* options) {
    return test::command(fmt::format("cd '{}' && {} '{}' map haptic-6psu --resume journal {}", (folder / ".").string(),
                                     before, test::program(), options));
  };
  map("trap '' XFSZ; ulimit -f 64;", "--n 9");  // ends when its journal is full
  const std::string kept = test::contents(folder / "journal");
  ASSERT_FALSE(kept.empty());
  const test::Run other = map("", "--n 8");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.out.find("is the journal of other work: it has 'command --n=9', this run 'command --n=8'"),
            std::string::npos)
      << other.out;
  EXPECT_EQ(test::contents(folder / "journal"), kept);
  EXPECT_EQ(map("", "--n 9").code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "journal"));
}

const auto name_of = [](const auto& each) { return std::string(each.param.name); };
INSTANTIATE_TEST_SUITE_P(Work, Interrupted, ::testing::ValuesIn(works), name_of);
INSTANTIATE_TEST_SUITE_P(Work, InterruptedLong, ::testing::ValuesIn(long_works), name_of);

}  // namespace
}  // namespace deflect::attack
