// The program under mpirun: one output, the same as of one process.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/paths.h"
#include "tests/support/program.h"

namespace deflect {
namespace {

using test::contents;

class MpiProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!DEFLECT_MPI) GTEST_SKIP() << "built without MPI";
    if (test::command("command -v mpirun").code != 0) GTEST_SKIP() << "no mpirun";
  }
  std::string path(const std::string& name) { return "'" + (folder / name).string() + "'"; }
  /// Open MPI refuses root by itself, and keeps memory to the end, which is no leak of the program's.
  static constexpr const char* environment = "OMPI_ALLOW_RUN_AS_ROOT=1 ASAN_OPTIONS=detect_leaks=0 ";
  /// Under mpirun, which by itself refuses root and more processes than cores; what it says of exit codes is left out.
  static test::Run on(int ranks, const std::string& arguments) {
    return test::command(environment +
                         std::string("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --quiet --oversubscribe -n ") +
                         std::to_string(ranks) + " '" + test::program() + "' " + arguments);
  }

  test::Folder folder;
};

TEST_F(MpiProgram, AMapIsTheSameFileForFile) {
  const std::string arguments = "map haptic-6psu --n 9,8,9 --z 120,300 --out ";
  const test::Run alone = test::deflect(arguments + path("one") + " --json " + path("one.json"));
  ASSERT_EQ(alone.code, 0) << alone.out;
  for (const int ranks : {2, 3}) {
    const std::string name = std::to_string(ranks);
    const test::Run run = on(ranks, arguments + path(name) + " --json " + path(name + ".json"));
    ASSERT_EQ(run.code, 0) << run.out;
    EXPECT_EQ(contents(folder / (name + ".json")), contents(folder / "one.json"));
    for (const char* file : {"map.csv", "map.vtu", "fig11.svg"})
      EXPECT_EQ(contents(folder / name / file), contents(folder / "one" / file)) << file;
    const std::size_t told = run.out.find("Tables map.csv");
    ASSERT_NE(told, std::string::npos) << run.out;
    EXPECT_EQ(run.out.substr(0, told), alone.out.substr(0, alone.out.find("Tables map.csv"))) << "said once";
  }
}

TEST_F(MpiProgram, ADiagnosisIsTheSame) {
  ASSERT_EQ(test::deflect("simulate haptic-6psu-ideal-joints --campaign paper --seed 4 -o " + path("data.csv")).code,
            0);
  const std::string arguments =
      "diagnose haptic-6psu-ideal-joints " + path("data.csv") + " --bootstrap 20000 --quiet --json ";
  ASSERT_EQ(test::deflect(arguments + path("one.json")).code, 0);
  const test::Run run = on(2, arguments + path("two.json"));
  ASSERT_EQ(run.code, 0) << run.out;
  EXPECT_EQ(contents(folder / "two.json"), contents(folder / "one.json"));
  EXPECT_EQ(nlohmann::json::parse(contents(folder / "two.json"))["bootstrap_sets"], 20000);
}

TEST_F(MpiProgram, ErrorsAreSaidOnceAndEndTheRun) {
  const auto once = [](const test::Run& run, const std::string& words) {
    const std::size_t at = run.out.find(words);
    EXPECT_NE(at, std::string::npos) << run.out;
    EXPECT_EQ(run.out.find(words, at + 1), std::string::npos) << run.out;
  };
  const test::Run unknown = on(3, "map no-such-device");
  EXPECT_EQ(unknown.code, 2);
  once(unknown, "there is no device 'no-such-device'");
  const test::Run usage = on(2, "map haptic-6psu --nonsense");
  EXPECT_EQ(usage.code, 2);
  once(usage, "--nonsense");
  ASSERT_EQ(test::command("touch " + path("file")).code, 0);
  const test::Run unwritable = on(2, "map haptic-6psu --n 3 --json " + path("file/map.json"));
  EXPECT_EQ(unwritable.code, 2);
  once(unwritable, "map.json");
}

TEST_F(MpiProgram, WorkThatIsNotSharedIsDoneOnce) {
  const test::Run run = on(2, "solve haptic-6psu --pose 0,0,198,0,0,0 --load 0,0,50 --json " + path("s.json"));
  EXPECT_EQ(run.code, 0) << run.out;
  EXPECT_NE(run.out.find("solve runs on one of the 2 processes"), std::string::npos) << run.out;
  EXPECT_TRUE(nlohmann::json::parse(contents(folder / "s.json")).contains("msa"));
}

TEST_F(MpiProgram, EachRunsForItselfWhereItIsAskedTo) {
  ASSERT_EQ(::setenv("DEFLECT_ALONE", "1", 1), 0);
  const test::Run run = on(2, "devices");
  ::unsetenv("DEFLECT_ALONE");
  EXPECT_EQ(run.code, 0) << run.out;
  const std::size_t at = run.out.find("stewart-6ups ");
  ASSERT_NE(at, std::string::npos) << run.out;
  EXPECT_NE(run.out.find("stewart-6ups ", at + 1), std::string::npos) << "two lists";
}

TEST_F(MpiProgram, ProcessesThatCannotFindEachOtherAreRefused) {
  const test::Run run =
      test::command(environment + std::string("PMI_SIZE=4 PMI_RANK=0 '") + test::program() + "' map haptic-6psu --n 3");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.out.find("started as one of 4"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("mpirun of that MPI"), std::string::npos) << run.out;
}

TEST_F(MpiProgram, AProgramWithoutTheModuleIsRefusedWithTheRemedy) {
  std::filesystem::copy_file(test::program(), folder / "deflect");
  const test::Run run = test::command("PMI_SIZE=2 PMI_RANK=0 DEFLECT_PLUGIN_DIR= " + path("deflect") + " devices");
  EXPECT_EQ(run.code, 2);
  for (const char* words : {"started as one of 2", "libopenmpi-dev", "without mpirun", "deflect_mpi.so: no such file"})
    EXPECT_NE(run.out.find(words), std::string::npos) << words << " is not in " << run.out;
  const test::Run other = test::command("PMI_SIZE=2 PMI_RANK=1 DEFLECT_PLUGIN_DIR= " + path("deflect") + " devices");
  EXPECT_EQ(other.code, 2);
  EXPECT_EQ(other.out, "") << "one of them says it";
}

}  // namespace
}  // namespace deflect
