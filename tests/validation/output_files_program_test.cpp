// What the program does to the files it is told to write.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "tests/support/paths.h"
#include "tests/support/program.h"

namespace deflect {
namespace {

namespace fs = std::filesystem;
using test::contents;

const std::string solve = "solve haptic-6psu --pose 0,0,173.9 --load 50,0,0 ";

class OutputFiles : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return "'" + (folder / name).string() + "'"; }
  std::size_t names(const fs::path& in) const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(in), fs::directory_iterator()));
  }

  test::Folder folder;
};

TEST_F(OutputFiles, ResultsCanGoToStandardOutput) {
  const test::Run quiet = test::deflect(solve + "--quiet --json /dev/stdout");
  ASSERT_EQ(quiet.code, 0) << quiet.out;
  ASSERT_EQ(test::deflect(solve + "--json " + path("x.json")).code, 0);
  EXPECT_EQ(quiet.out, contents(folder / "x.json"));
  // Into a file, behind what was printed before and before what is printed after.
  ASSERT_EQ(test::command("'" + test::program() + "' simulate haptic-6psu --campaign paper --seed 1 -o /dev/stdout > " +
                          path("x.csv"))
                .code,
            0);
  const std::string csv = contents(folder / "x.csv");
  EXPECT_TRUE(csv.starts_with("pose,")) << csv.substr(0, 80);
  EXPECT_NE(csv.find("27 readings"), std::string::npos) << "what is printed after is not lost";
}

/// Names of files are bytes; JSON is UTF-8.
TEST_F(OutputFiles, AFileWhoseNameIsNoUtf8IsReadAndWritten) {
  const std::string data = path("messung-\xfc.csv"), device = path("ger\xe4t.yaml");
  ASSERT_EQ(test::command("cp '" + test::source_dir() + "/validation/devices/haptic-6psu.yaml' " + device).code, 0);
  test::Run run =
      test::deflect("simulate " + device + " --campaign paper --seed 1 -o " + data + " --json " + path("s.json"));
  EXPECT_EQ(run.code, 0) << run.out;
  EXPECT_NE(contents(folder / "s.json").find("messung-\xef\xbf\xbd.csv"), std::string::npos);
  run = test::deflect("compare " + device + " " + data + " --json " + path("c.json") + " --report " + path("c.html"));
  EXPECT_EQ(run.code, 0) << run.out;
}

TEST_F(OutputFiles, DevicesAndFifosAreWrittenTo) {
  fs::create_symlink("/dev/null", folder / "null.vtu");
  EXPECT_EQ(test::deflect("export haptic-6psu --to vtk -o " + path("null.vtu")).code, 0);
  EXPECT_TRUE(fs::is_symlink(folder / "null.vtu"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  for (const char* kind : {"vtk -o pipe.vtu", "msh -o pipe.msh"}) {
    const std::string file = std::string(kind).substr(7);
    const test::Run run = test::command("cd " + path("") + " && mkfifo " + file + " && { cat " + file + " > seen & '" +
                                        test::program() + "' export haptic-6psu --to " + kind + " && wait; }");
    EXPECT_EQ(run.code, 0) << run.out;
    EXPECT_TRUE(fs::is_fifo(folder / file));
    EXPECT_GT(contents(folder / "seen").size(), 1000u);
  }
}

TEST_F(OutputFiles, LinksAndModesStayAndReadOnlyFilesAreRefused) {
  std::ofstream(folder / "real.json") << "old";
  fs::create_symlink("real.json", folder / "link.json");
  ASSERT_EQ(::chmod((folder / "real.json").c_str(), 0600), 0);
  ASSERT_EQ(test::deflect(solve + "--json " + path("link.json")).code, 0);
  EXPECT_TRUE(fs::is_symlink(folder / "link.json"));
  EXPECT_TRUE(contents(folder / "real.json").starts_with("{"));
  EXPECT_EQ(fs::status(folder / "real.json").permissions(), fs::perms::owner_read | fs::perms::owner_write);

  for (const char* file : {"x.vtu", "x.msh"}) {
    std::ofstream(folder / file) << "old";
    ASSERT_EQ(::chmod((folder / file).c_str(), 0444), 0);
    const test::Run run =
        test::deflect(std::string("export haptic-6psu --to ") + (file[2] == 'v' ? "vtk" : "msh") + " -o " + path(file));
    EXPECT_EQ(run.code, 2);
    EXPECT_NE(run.out.find("it is read-only: make it writable"), std::string::npos) << run.out;
    EXPECT_EQ(contents(folder / file), "old");
  }
}

// By its name, by a link, in a folder of results: measurements stay what they were.
TEST_F(OutputFiles, WhatIsReadIsNotWrittenOver) {
  const std::string device = "haptic-6psu-ideal-joints ", data = path("data.csv");
  ASSERT_EQ(test::deflect("simulate " + device + "--campaign paper --seed 1 -o " + data).code, 0);
  fs::create_symlink("data.csv", folder / "link.csv");
  fs::create_hard_link(folder / "data.csv", folder / "residuals.csv");
  const std::string before = contents(folder / "data.csv");
  for (const std::string& words :
       {"compare " + device + data + " --json " + data, "compare " + device + data + " --report " + data,
        "compare " + device + data + " --json " + path("link.csv"), "history " + data + " " + device + "--json " + data,
        "simulate " + device + "--campaign " + data + " -o " + data,
        "compare " + device + data + " --out " + path(".")}) {
    const test::Run run = test::deflect(words);
    EXPECT_EQ(run.code, 2) << words;
    EXPECT_NE(run.out.find("this is an input file: name another"), std::string::npos) << words << "\n" << run.out;
    EXPECT_EQ(contents(folder / "data.csv"), before) << words;
  }
}

// A built-in device has a file too. (What else is wrong would be said after that, so that nothing is written.)
TEST_F(OutputFiles, ABuiltInDeviceIsNotWrittenOver) {
  const test::Run run = test::deflect("add haptic-6psu modulus --set factor=much -o '" + test::source_dir() +
                                      "/validation/devices/haptic-6psu.yaml'");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.out.find("this is an input file: name another, or overwrite it with --force"), std::string::npos)
      << run.out;
}

TEST_F(OutputFiles, TheNameOfACampaignIsNoFile) {
  const test::Run run = test::command("cd " + path(".") + " && '" + test::program() +
                                      "' simulate haptic-6psu --campaign paper --seed 1 -o paper");
  EXPECT_EQ(run.code, 0) << run.out;
  EXPECT_TRUE(fs::exists(folder / "paper"));
}

TEST_F(OutputFiles, TwoOutputsAreTwoFiles) {
  const test::Run run =
      test::deflect("simulate haptic-6psu --campaign paper -o " + path("two.csv") + " --json " + path("./two.csv"));
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.out.find("are one file"), std::string::npos) << run.out;
  EXPECT_FALSE(fs::exists(folder / "two.csv"));
  EXPECT_EQ(test::deflect("simulate haptic-6psu --campaign paper -o /dev/null --json /dev/null").code, 0);
}

// Texts longer than a buffer and short ones, by a full disk and by a pipe that nobody reads; where messages cannot be
// written the code is the same.
TEST_F(OutputFiles, LostWordsAreNoBugAndChangeNoCode) {
  const std::string program = "'" + test::program() + "' ";
  for (const char* words : {"effects", "devices --schema", "--help", "solve haptic-6psu --pose 0,0,173.9"}) {
    EXPECT_EQ(test::command(program + words + " > /dev/full").code, 2) << words;
    EXPECT_EQ(test::command("trap '' PIPE; { " + program + words + "; echo $? > " + path("code") + "; } | true").code,
              0);
    EXPECT_EQ(contents(folder / "code"), "2\n") << words;
  }
  EXPECT_EQ(test::command(program + "solve haptic-6psu --pose 0,0,9999 2> /dev/full").code, 3);
  EXPECT_EQ(test::command(program + "nothing 2>&-").code, 2);
  EXPECT_EQ(test::command(program + solve + "--verbose > /dev/null 2> /dev/full").code, 0);
}

TEST_F(OutputFiles, ANameInADeviceLeadsOutOfNoFolder) {
  std::ofstream(folder / "device.yaml") << R"(
name: ../../far/x
kinematics: {family: chains}
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {rod: {shape: round, diameter: 20 mm}}
leg: {rod: {member: rod, material: steel, along: [0 mm, 0 mm, 300 mm]}}
workspace: {cube_edge: 50 mm}
)";
  fs::create_directories(folder / "a" / "b" / "out");
  for (const char* format : {"vtk", "msh"})
    ASSERT_EQ(
        test::deflect(std::string("export --to ") + format + " --out " + path("a/b/out") + " " + path("device.yaml"))
            .code,
        0);
  EXPECT_EQ(names(folder / "a" / "b" / "out"), 5u) << "two of each and Gmsh's options";
  EXPECT_EQ(names(folder / "a"), 1u);
  EXPECT_FALSE(fs::exists(folder / "a" / "far"));
}

TEST_F(OutputFiles, PartFilesOfKilledRunsGo) {
  const auto left = [&](const std::string& name) {
    const fs::path part = folder / name;
    std::ofstream(part) << "half";
    return part;
  };
  const std::string dead = test::command("sh -c 'echo $$'").out;  // ended by now
  const std::string number = dead.substr(0, dead.find('\n'));
  const fs::path csv = left("x.csv.part" + number), msh = left("x.msh.part" + number + ".msh"),
                 alive = left("x.csv.part" + std::to_string(::getpid()));
  ASSERT_EQ(test::deflect("simulate haptic-6psu --campaign paper --seed 1 -o " + path("x.csv")).code, 0);
  ASSERT_EQ(test::deflect("export haptic-6psu --to msh -o " + path("x.msh")).code, 0);
  EXPECT_FALSE(fs::exists(csv));
  EXPECT_FALSE(fs::exists(msh));
  EXPECT_TRUE(fs::exists(alive));
}

}  // namespace
}  // namespace deflect
