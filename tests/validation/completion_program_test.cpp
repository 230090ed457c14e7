// `deflect completion bash` in a real bash: what is offered is what the help says.
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>
#include <sstream>
#include <string>

#include "tests/support/paths.h"
#include "tests/support/program.h"

namespace deflect {
namespace {

using Words = std::set<std::string>;

Words words_of(const std::string& text) {
  std::istringstream in(text);
  Words words;
  for (std::string word; in >> word;) words.insert(word);
  return words;
}

/// What bash offers for the last of these words, the cursor at its end; in an empty folder.
Words offered(const std::string& line) {
  static const test::Folder folder;
  std::filesystem::create_directory(folder / "empty");
  {
    std::ofstream script(folder / "offer.sh");
    script << "source <('" << test::program() << "' completion bash) || exit 1\n"
           << "COMP_WORDS=(" << line << ") COMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n"
           << "_deflect; printf '%s\\n' \"${COMPREPLY[@]}\"\n";
  }
  return words_of(test::command("cd '" + (folder / "empty").string() + "' && bash ../offer.sh").out);
}

/// The words that stand first in the lines of a help below a heading.
Words listed(const std::string& help, const std::string& heading) {
  std::istringstream in(help.substr(std::min(help.find(heading), help.size())));
  Words words;
  std::string line;
  for (std::getline(in, line); std::getline(in, line) && !line.empty();)
    if (line.size() > 2 && line.starts_with("  ") && line[2] != ' ')
      for (std::string word : words_of(line.substr(2, line.find(' ', 2) - 2)))
        for (std::size_t comma; !word.empty(); word = comma == word.npos ? "" : word.substr(comma + 1))
          words.insert(word.substr(0, comma = word.find(',')));
  return words;
}

TEST(CompletionProgram, OffersEveryCommandAndEveryOptionOfTheHelp) {
  const Words commands = listed(test::deflect("--help").out, "Subcommands:");
  ASSERT_TRUE(commands.contains("solve") && commands.contains("completion"));
  Words wanted = commands;
  wanted.insert({"--help", "--version"});
  EXPECT_EQ(offered("deflect ''"), wanted);
  for (const std::string& command : commands) {
    Words options = listed(test::deflect(command + " --help").out, "Options:");
    options.erase("-h");
    EXPECT_EQ(offered("deflect " + command + " -"), options) << command;
  }
}

TEST(CompletionProgram, OffersNamesOfDevicesEffectsAndFrames) {
  Words devices;
  for (const std::string& name : words_of(test::deflect("devices | cut -d ' ' -f 1").out)) devices.insert(name);
  ASSERT_TRUE(devices.contains("haptic-6psu"));
  for (const char* line : {"deflect solve ''", "deflect devices ''", "deflect check K.csv --device ''",
                           "deflect history data.csv ''", "deflect history data.csv delta tripteron ''"})
    EXPECT_EQ(offered(line), devices) << line;
  EXPECT_EQ(offered("deflect solve haptic-6psu-"), Words{"haptic-6psu-ideal-joints"});
  EXPECT_EQ(offered("deflect effects guide_root"), Words{"guide_root_compliance"});
  EXPECT_EQ(offered("deflect add delta guide_root"), Words{"guide_root_compliance"});
  EXPECT_EQ(offered("deflect frame logan"), (Words{"logan-5-8", "logan-5-30"}));
}

TEST(CompletionProgram, OffersTheValuesOfAnOption) {
  const Words geometries = {"linear", "second-order", "finite"};
  EXPECT_EQ(offered("deflect solve delta --geometry ''"), geometries);
  EXPECT_EQ(offered("deflect solve delta --geometry = f"), Words{"finite"});           // bash splits at =
  EXPECT_EQ(offered("deflect solve delta --load ''"), Words{});                        // numbers cannot be listed
  EXPECT_TRUE(offered("deflect effects --effects mine.yaml --y").contains("--yaml"));  // after one of several values
  EXPECT_TRUE(offered("deflect solve delta --geometry finite ''").contains("--load"));
  EXPECT_EQ(offered("deflect solve delta --theories m"), Words{"msa"});
  EXPECT_TRUE(offered("deflect new --like trip").contains("tripteron"));
}

TEST(CompletionProgram, KnowsNoOtherShell) {
  const test::Run run = test::deflect("completion fish");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.out.find("only for bash"), std::string::npos) << run.out;
}

}  // namespace
}  // namespace deflect
