// Linked into the test programs of mutation testing: writes a line per test to the file DEFLECT_MUTATION_LOG: its name,
// its milliseconds, how it ended, and the numbers of the faults whose places it passed. A test may take so many seconds
// of the processor as DEFLECT_MUTATION_LIMIT says, or its own line "name seconds" in the file DEFLECT_MUTATION_LIMITS;
// one that takes longer ends the program with its line in the log.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/time.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <string>

#include "tests/mutation/mutant.h"

namespace deflect::mutation {
namespace {

constexpr int too_long = 75;  // exit code

int log_file = -1;
char running[1000] = "";
timeval begun = {};

double milliseconds_since(const timeval& from) {
  timeval now = {};
  ::gettimeofday(&now, nullptr);
  return 1e3 * static_cast<double>(now.tv_sec - from.tv_sec) + 1e-3 * static_cast<double>(now.tv_usec - from.tv_usec);
}

/// Allocates nothing: it also runs within a signal.
void write_line(const char* how) {
  static char line[8 * most];
  int length = std::snprintf(line, sizeof line, "%s\t%.0f\t%s\t", running, milliseconds_since(begun), how);
  for (int number = 1; number < most; ++number)
    if (reached[number])
      length += std::snprintf(line + length, sizeof line - static_cast<std::size_t>(length), " %d", number);
  line[length++] = '\n';
  if (::write(log_file, line, static_cast<std::size_t>(length)) < 0) ::_exit(1);
}

void stop(int) {
  write_line("too long");
  ::_exit(too_long);
}

void set_limit(double seconds) {
  itimerval limit = {};
  limit.it_value.tv_sec = static_cast<time_t>(seconds);
  limit.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (seconds - static_cast<double>(limit.it_value.tv_sec)));
  ::setitimer(ITIMER_PROF, &limit, nullptr);
}

class Recorder : public ::testing::EmptyTestEventListener {
 public:
  Recorder() {
    if (const char* text = std::getenv("DEFLECT_MUTATION_LIMIT")) limit_ = std::atof(text);
    if (const char* file = std::getenv("DEFLECT_MUTATION_LIMITS")) {
      std::ifstream in(file);
      std::string name;
      for (double seconds = 0; in >> name >> seconds;) limits_[name] = seconds;
    }
    std::signal(SIGPROF, stop);
  }

  void OnTestStart(const ::testing::TestInfo& test) override {
    std::snprintf(running, sizeof running, "%s.%s", test.test_suite_name(), test.name());
    std::memset(reached, 0, sizeof reached);
    ::gettimeofday(&begun, nullptr);
    const auto own = limits_.find(running);
    set_limit(own == limits_.end() ? limit_ : own->second);
  }

  void OnTestEnd(const ::testing::TestInfo& test) override {
    set_limit(0);
    const ::testing::TestResult& result = *test.result();
    write_line(result.Failed() ? "failed" : result.Skipped() ? "skipped" : "passed");
  }

 private:
  double limit_ = 0;  // none
  std::map<std::string, double> limits_;
};

const bool listening = [] {
  const char* file = std::getenv("DEFLECT_MUTATION_LOG");
  if (!file) return false;
  log_file = ::open(file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  ::testing::UnitTest::GetInstance()->listeners().Append(new Recorder());
  return true;
}();

}  // namespace
}  // namespace deflect::mutation
