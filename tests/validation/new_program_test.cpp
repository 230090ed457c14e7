// `deflect new`: a first file of each kind runs through every command that it names.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/paths.h"
#include "tests/support/program.h"
#include "validation/page/page.h"

namespace deflect {
namespace {

using namespace page;

using test::contents;

class NewProgram : public ::testing::TestWithParam<const char*> {
 protected:
  /// A command as it is printed, run where the file is.
  test::Run typed(std::string line) const {
    EXPECT_TRUE(line.starts_with("deflect "));
    line = line.substr(8);
    const std::size_t page = line.find(" --report");
    if (page != line.npos && !pages_are_built()) line = line.substr(0, page);
    if (line.starts_with("diagnose")) line += " --bootstrap 99";
    return test::command("cd '" + (folder / "").string() + "' && '" + test::program() + "' " + line);
  }

  test::Folder folder;
};

TEST_P(NewProgram, RunsThroughEveryCommandThatItNames) {
  const std::string kind = GetParam();
  const test::Run made = typed("deflect new --like " + kind + " -o mine.yaml");
  ASSERT_EQ(made.code, 0) << made.out;
  const std::string text = contents(folder / "mine.yaml");
  EXPECT_TRUE(text.starts_with("# Edit this file and try:\n#   deflect show mine.yaml")) << text.substr(0, 300);
  EXPECT_NE(text.find("\nname: mine\n"), text.npos);

  std::vector<std::string> commands;
  std::istringstream lines(made.out.substr(made.out.find("Try:\n") + 5));
  for (std::string line; std::getline(lines, line);) {
    commands.push_back(line.substr(line.find_first_not_of(' ')));
    EXPECT_NE(text.find("#   " + commands.back() + "\n"), text.npos) << commands.back();
  }
  const bool frame = kind == "truss" || kind == "portal";
  ASSERT_EQ(commands.size(), frame ? 2u : 6u) << made.out;
  for (const std::string& command : commands) {
    const test::Run run = typed(command);
    EXPECT_EQ(run.code, 0) << command << "\n" << run.out;
    EXPECT_EQ(run.out.find("nan"), run.out.npos) << command << "\n" << run.out;
  }
  // Every comment block stands above a key, so that each of them explains something.
  for (const char* key : {"\nmaterials:", "\nsections:"}) {
    const std::size_t at = text.find(key);
    ASSERT_NE(at, text.npos) << key;
    EXPECT_EQ(text[text.rfind('\n', at - 1) + 1], '#') << key;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, NewProgram,
                         ::testing::Values("scara", "arm", "gantry", "delta", "hexapod", "3-rrr", "3-upu", "flexure",
                                           "truss", "portal"),
                         [](const auto& p) {
                           std::string name = p.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

class NewFile : public NewProgram {};

TEST_P(NewFile, WritesOverNothingUnlessTold) {
  std::ofstream(folder / "mine.yaml") << "precious";
  const test::Run run = typed("deflect new --like scara -o mine.yaml");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.out.find("mine.yaml: exists already: name another file, or overwrite it with --force"), run.out.npos)
      << run.out;
  EXPECT_EQ(contents(folder / "mine.yaml"), "precious");
  EXPECT_EQ(typed("deflect new --like scara --force -o mine.yaml").code, 0);
  EXPECT_NE(contents(folder / "mine.yaml"), "precious");
  const test::Run near = typed("deflect new --like scarab -o other.yaml");
  EXPECT_EQ(near.code, 2);
  EXPECT_NE(near.out.find("--like scarab: there is no such machine, did you mean 'scara'?"), near.out.npos) << near.out;
  // Any built-in machine, and names of files that are none of a device.
  EXPECT_EQ(typed("deflect new --like tripteron -o '2 of them.yaml'").code, 0);
  EXPECT_EQ(typed("deflect show '2 of them.yaml'").code, 0);
}

// By such a name every command would read the built-in one, whatever is changed in the file.
TEST_P(NewFile, HasNoNameThatIsBuiltIn) {
  const test::Run run = typed("deflect new --like scara -o scara");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.out.find("-o scara: commands would read the built-in scara by this name, and not the new file: write "
                         "scara.yaml"),
            run.out.npos)
      << run.out;
  EXPECT_EQ(typed("deflect new --like scara -o ./scara").code, 0);
  EXPECT_EQ(typed("deflect new --like scara -o plain").code, 0);
  EXPECT_EQ(typed("deflect show plain").code, 0);
}

INSTANTIATE_TEST_SUITE_P(Once, NewFile, ::testing::Values(""));

}  // namespace
}  // namespace deflect
