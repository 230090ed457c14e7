// How much the program tells: --quiet and --verbose of every command.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/program.h"

namespace deflect {
namespace {

using test::contents;

constexpr const char* commands[] = {"solve",   "validate", "frame",   "map",      "export",   "devices", "check",
                                    "effects", "add",      "compare", "simulate", "diagnose", "history", "report"};

class TalkProgram : public ::testing::Test {
 protected:
  std::string path(const std::string& name) { return "'" + (folder / name).string() + "'"; }
  struct Apart {
    int code;
    std::string out, errors;
  };
  /// Standard output and error apart.
  Apart run(const std::string& arguments) {
    const test::Run run = test::deflect(arguments + " 2>" + path("errors") + " #");
    return {run.code, run.out, contents(folder / "errors")};
  }

  test::Folder folder;
};

TEST_F(TalkProgram, EveryCommandHasBothAndOnlyOneAtATime) {
  for (const char* command : commands) {
    const Apart help = run(std::string(command) + " --help");
    EXPECT_NE(help.out.find("--quiet"), std::string::npos) << command;
    EXPECT_NE(help.out.find("--verbose"), std::string::npos) << command;
  }
  const Apart both = run("devices --quiet --verbose");
  EXPECT_EQ(both.code, 2);
  EXPECT_NE(both.errors.find("excludes"), std::string::npos) << both.errors;
}

TEST_F(TalkProgram, QuietPrintsNothingAndWritesAllTheSame) {
  const std::string solve = "solve haptic-6psu --pose 0,0,173.9 --load 50,0,0 --json ";
  const Apart usual = run(solve + path("usual.json"));
  const Apart quiet = run(solve + path("quiet.json") + " --quiet");
  EXPECT_EQ(quiet.code, 0) << quiet.errors;
  EXPECT_FALSE(usual.out.empty());
  EXPECT_EQ(quiet.out, "");
  EXPECT_EQ(quiet.errors, "");
  EXPECT_FALSE(contents(folder / "quiet.json").empty());
  EXPECT_EQ(contents(folder / "quiet.json"), contents(folder / "usual.json"));
  EXPECT_EQ(run("devices --quiet").out, "");
}

TEST_F(TalkProgram, QuietStillSaysWhatIsWrong) {
  const Apart wrong = run("solve haptic-6ps --pose 0,0,173.9 --quiet");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_EQ(wrong.out, "");
  EXPECT_NE(wrong.errors.find("did you mean 'haptic-6psu'?"), std::string::npos) << wrong.errors;
}

TEST_F(TalkProgram, VerboseTellsStepsOnStandardErrorAndChangesNothingElse) {
  const std::string data = path("data.csv");
  const Apart simulated =
      run("simulate haptic-6psu-ideal-joints --campaign paper --with guide_root_compliance,stiffness_Nmm_per_rad=1e6 "
          "--threads 2 --verbose -o " +
          data);
  ASSERT_EQ(simulated.code, 0) << simulated.errors;
  for (const char* told : {"effects: ", "hidden: guide_root_compliance", "threads: 2", "campaign paper: 27 readings",
                           "simulate: MSA at every reading: "})
    EXPECT_NE(simulated.errors.find(told), std::string::npos) << told << "\n" << simulated.errors;

  const Apart usual = run("compare haptic-6psu-ideal-joints " + data + " --out " + path("out"));
  const Apart verbose = run("compare haptic-6psu-ideal-joints " + data + " --verbose --out " + path("out"));
  ASSERT_EQ(verbose.code, 0) << verbose.errors;
  EXPECT_EQ(usual.errors, "");
  EXPECT_EQ(verbose.out, usual.out);
  for (const char* told : {"version ", "BLAS", "device haptic-6psu-ideal-joints: ", "27 readings at 9 poses",
                           "threads: all ", "figures ", "residual-map: 160 x ", "wrote ", "errors.csv", "compare: "})
    EXPECT_NE(verbose.errors.find(told), std::string::npos) << told << "\n" << verbose.errors;
}

}  // namespace
}  // namespace deflect
