// Linked into the test programs of mutation testing: writes a line per test to the file DEFLECT_MUTATION_LOG: its name,
// its milliseconds, whether it passed, and the numbers of the faults whose places it passed.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "tests/mutation/mutant.h"

namespace deflect::mutation {
namespace {

class Recorder : public ::testing::EmptyTestEventListener {
 public:
  explicit Recorder(const char* file) : out_(file, std::ios::app) {}

  void OnTestStart(const ::testing::TestInfo&) override { std::memset(reached, 0, sizeof reached); }

  void OnTestEnd(const ::testing::TestInfo& test) override {
    const ::testing::TestResult& result = *test.result();
    out_ << test.test_suite_name() << '.' << test.name() << '\t' << result.elapsed_time() << '\t'
         << (result.Failed()    ? "failed"
             : result.Skipped() ? "skipped"
                                : "passed")
         << '\t';
    for (int number = 1; number < most; ++number)
      if (reached[number]) out_ << ' ' << number;
    out_ << std::endl;
  }

 private:
  std::ofstream out_;
};

const bool listening = [] {
  const char* file = std::getenv("DEFLECT_MUTATION_LOG");
  if (file) ::testing::UnitTest::GetInstance()->listeners().Append(new Recorder(file));
  return file != nullptr;
}();

}  // namespace
}  // namespace deflect::mutation
