// Every object that --json writes says what it is.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "msa/base/error.h"
#include "tests/support/program.h"
#include "validation/result_files/result_file.h"

namespace deflect {
namespace {

using namespace result_files;

TEST(ResultKind, IsSaidByEveryResultAndRead) {
  const test::Folder folder;
  const std::string data = (folder / "data.csv").string(), file = (folder / "result.json").string();
  const std::string device = "haptic-6psu-ideal-joints";
  ASSERT_EQ(test::deflect("simulate " + device + " --campaign paper --geometry linear --elements 1 -o " + data).code,
            0);
  const std::pair<const char*, std::string> commands[] = {
      {"solve", "solve " + device + " --pose 0,0,198.9 --load 50,0,0"},
      {"validation", "validate " + device},
      {"map", "map " + device + " --n 2,1,1"},
      {"frame", "frame portal"},
      {"drawing", "show scara"},
      {"comparison", "compare " + device + " " + data},
      {"diagnosis", "diagnose " + device + " " + data},
      {"history", "history " + data + " " + device},
      {"fit", "fit " + device + " " + data + " --free materials.*.E --force -o " + (folder / "new.yaml").string()},
      {"prediction", "predict " + device + " --at 0,0,198.9 --load 50,0,0"},
      {"validity", "compare " + device + " " + data + " --validation"},
      {"foresight", "plan " + device + " --before paper"},
  };
  for (const auto& [kind, command] : commands) {
    const test::Run run = test::deflect(command + " --json " + file);
    ASSERT_EQ(run.code, 0) << command << "\n" << run.out;
    const std::string text = test::contents(file);
    EXPECT_EQ(nlohmann::json::parse(text).at("kind"), kind) << command;
    EXPECT_EQ(read_result(text, "result.json").kind, kind) << command;
  }
}

// A result that says its kind is held to it, whatever members it has.
TEST(ResultKind, IsNotGuessedWhereItIsSaid) {
  EXPECT_THROW(read_result(R"({"kind": "map", "verdict": "none", "candidates": []})", "r.json"), InputError);
  EXPECT_THROW(read_result(R"({"kind": "recipe", "verdict": "none", "candidates": []})", "r.json"), InputError);
}

}  // namespace
}  // namespace deflect
