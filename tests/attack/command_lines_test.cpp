// Random command lines: of every command a right one, in which words are changed, left out and put in. Whatever it is,
// the program says what it wants with an exit code of its own, or answers with numbers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <regex>
#include <sstream>
#include <vector>

#include "tests/attack/count.h"
#include "tests/attack/random_frame.h"
#include "tests/support/program.h"
#include "tests/support/sanitizers.h"

namespace deflect::attack {
namespace {

constexpr unsigned usual_lines = 200, line_shards = 8;
constexpr int most_seconds = 100 * test::times_slower;

using Words = std::vector<std::string>;

/// Right ones, quick ones; the files are those of `prepare`.
const std::vector<std::string> right_lines = {
    "solve haptic-6psu --pose 0,0,173.9 --load 50,0,0",
    "solve tripteron --pose 500,500,500 --load 0,0,50 --geometry finite",
    "solve arm --joints 10,20,30,40,50,60 --load 5,0,0,1000,0,0",
    "validate haptic-6psu --force 30",
    "frame truss-45",
    "frame frame.yaml --json out.json",
    "map haptic-6psu --n 2,1,2 --load 0,0,10",
    "export arm --to msh -o arm.msh",
    "check matrix.csv --unit m --size 300mm",
    "effects joint_clearance --device haptic-6psu-ideal-joints",
    "add haptic-6psu-ideal-joints joint_clearance --set gap_mm=0.02 -o after.yaml",
    "compare portal-semi-rigid data.csv --json out.json",
    "compare machine.yaml machine.csv --sigma 0.002",
    "simulate portal-semi-rigid --with factor@right,factor=0.8 --seed 3 -o out.csv",
    "simulate haptic-6psu-ideal-joints --campaign paper --noise 0.001 --tolerances 2 --outliers 0.1 -o out.csv",
    "diagnose portal-semi-rigid data.csv --bootstrap 99 --json out.json",
    "history data.csv portal-semi-rigid portal.yaml",
    "report found.json -o page.html",
    "fit portal-semi-rigid data.csv --free members.right.factor --prior members.right.factor=1±0.1 -o fitted.yaml",
    "predict tripteron --at 500,500,500 --load 0,0,50 --sigma 0.001",
    "plan portal-semi-rigid --before data.csv --readings 5 -o plan.csv",
    "reproduce found.json --tolerance 1e-9",
    "show portal-semi-rigid",
    "devices arm",
    "new --like scara -o mine.yaml",
    "completion bash"};

const Words odd_values = {"nan",
                          "inf",
                          "-inf",
                          "0",
                          "-1",
                          "-0",
                          "7",
                          "0.5",
                          "1e308",
                          "1e-308",
                          "1e400",
                          "99999999999999999999",
                          "0x10",
                          "''",
                          "' '",
                          "1,2",
                          "1,2,3",
                          "0,0,0",
                          "nan,0,0",
                          "1e30,0,0",
                          "0,0,1e-30",
                          "500,500,500",
                          "0,0,173.9",
                          "1,2,3,4,5,6",
                          "2,2,2",
                          "é",
                          "$(printf '\\377')",
                          "$(printf 'x%.0s' $(seq 300))",
                          "/proc",
                          "/dev/null",
                          ".",
                          "data.csv",
                          "found.json",
                          "machine.yaml",
                          "matrix.csv",
                          "frame.yaml",
                          "nosuch",
                          "=",
                          "a=b",
                          "@",
                          "x@y",
                          "factor@",
                          "@right",
                          "factor@right",
                          "factor@right,factor=nan",
                          "factor@right,factor=0",
                          "factor@right,factor=-1",
                          "gap_mm=0",
                          "gap_mm=1e9",
                          "joint_clearance",
                          "±",
                          "1±0",
                          "1±-1",
                          "members.right.factor=1±nan",
                          "members.right.factor",
                          "5mm",
                          "'5 mm'",
                          "5N",
                          "1deg",
                          "true",
                          "null",
                          "'[]'",
                          "'{}'",
                          "--",
                          "-",
                          "'*'",
                          "%s",
                          "%n",
                          "'a;b'",
                          "linear",
                          "finite",
                          "second-order",
                          "vtk",
                          "all",
                          "none",
                          "down=1",
                          "load.down=1"};

void prepare(const std::string& in) {
  for (const char* line : {"simulate portal-semi-rigid --with factor@right,factor=0.8 --seed 3 -o data.csv",
                           "diagnose portal-semi-rigid data.csv --bootstrap 99 --json found.json",
                           "new --like arm -o machine.yaml --force", "new --like truss -o frame.yaml --force",
                           "simulate machine.yaml --campaign paper --seed 1 -o machine.csv",
                           "add portal-semi-rigid factor@right --set factor=0.8 -o portal.yaml --force"}) {
    const test::Run run = test::command("cd '" + in + "' && '" + test::program() + "' " + line);
    ASSERT_EQ(run.code, 0) << line << "\n" << run.out;
  }
  std::ofstream matrix(std::filesystem::path(in) / "matrix.csv");
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) matrix << (i == j ? "1e5" : "0") << (j < 5 ? "," : "\n");
}

Words words_of(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), {}};
}

/// As the command's own help lists them.
const Words& options_of(const std::string& command) {
  static std::map<std::string, Words> known;
  const auto [at, fresh] = known.try_emplace(command);
  if (!fresh) return at->second;
  const std::string help = test::deflect(command + " --help").out;
  const std::regex option("--[a-z][a-z-]*");
  for (std::sregex_iterator found(help.begin(), help.end(), option), end; found != end; ++found)
    at->second.push_back(found->str());
  return at->second;
}

template <class T>
const T& any_of(Dice& dice, const std::vector<T>& all) {
  return all[static_cast<std::size_t>(dice.whole(0, static_cast<int>(all.size()) - 1))];
}

std::string random_line(unsigned seed) {
  Dice dice(seed);
  Words words = words_of(any_of(dice, right_lines));
  const std::string command = words.front();
  for (int changes = dice.whole(1, 3); changes > 0; --changes) {
    const auto at = static_cast<std::size_t>(dice.whole(1, std::max(1, static_cast<int>(words.size()) - 1)));
    const double kind = dice.real(0, 1);
    if (kind < 0.45 && !options_of(command).empty()) {
      words.push_back(any_of(dice, options_of(command)));
      if (dice.chance(0.85)) words.push_back(any_of(dice, odd_values));
    } else if (kind < 0.9 && at < words.size()) {
      if (words[at][0] != '-' || dice.chance(0.1)) words[at] = any_of(dice, odd_values);
    } else if (at < words.size()) {
      words.erase(words.begin() + static_cast<std::ptrdiff_t>(at));
    }
  }
  return fmt::format("{}", fmt::join(words, " "));
}

/// What is wrong with the answer to a line; empty where nothing is.
std::string complaint(const std::string& line, const std::string& in) {
  const std::string command =
      fmt::format("cd '{}' && ulimit -t {} && '{}' {} </dev/null", in, most_seconds, test::program(), line);
  const test::Run run = test::command(command);
  const bool own_code = run.code == 0 || (run.code >= 2 && run.code <= 4);
  if (!own_code) return fmt::format("{}\n  exit code {}: {}\n", line, run.code, run.out.substr(0, 300));
  if (run.code != 0 && run.out.find_first_not_of(" \n") == run.out.npos) return line + "\n  refused without a word\n";
  static const std::regex no_number(R"((^|[\s(\[,])-?nan([\s)\],]|$))");
  if (run.code == 0 && std::regex_search(run.out, no_number)) return line + "\n  answers nan\n";
  return "";
}

std::string complaints(unsigned first, unsigned last, unsigned step) {
  std::string out;
  std::optional<test::Folder> folder;
  for (unsigned seed = first; seed < last; seed += step) {
    // Files that a line has overwritten are made anew.
    if (!folder || (seed / step) % 50 == 49) prepare((folder.emplace() / ".").string());
    if (const std::string wrong = complaint(random_line(seed), (*folder / ".").string()); !wrong.empty())
      out += fmt::format("seed {}: {}", seed, wrong);
  }
  return out;
}

class CommandLines : public ::testing::TestWithParam<unsigned> {};

TEST_P(CommandLines, AreAnsweredOrRefusedWithAWord) { EXPECT_EQ(complaints(GetParam(), usual_lines, line_shards), ""); }

INSTANTIATE_TEST_SUITE_P(Shard, CommandLines, ::testing::Range(0u, line_shards));

TEST(CommandLinesOnDemand, AreAnsweredOrRefusedWithAWord) {
  if (count_on_demand() == 0) GTEST_SKIP() << "set DEFLECT_ATTACK to the number of command lines";
  EXPECT_EQ(complaints(first_on_demand(), count_on_demand(), 1), "");
}

}  // namespace
}  // namespace deflect::attack
