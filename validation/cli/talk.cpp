#include "validation/cli/talk.h"

#include <chrono>
#include <cstdio>
#include <exception>

#include "msa/base/error.h"
#include "validation/parallel/progress.h"

namespace deflect::cli {
namespace {

Talk talk = Talk::usual;

double seconds() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void set_talk(Talk wanted) {
  talk = wanted;
  seconds();
  if (talk != Talk::quiet) return;
  // The descriptor stays: results may be written to /dev/stdout.
  std::FILE* const nowhere = std::fopen("/dev/null", "w");
  if (!nowhere) throw InputError("--quiet: /dev/null cannot be opened");
  stdout = nowhere;
}

bool verbose() { return talk == Talk::verbose; }

parallel::ProgressStream progress_stream() { return talk == Talk::quiet ? nullptr : parallel::watched_stream(); }

void say(const std::string& text) { std::fputs(text.c_str(), stderr); }

void tell_line(const std::string& text) {
  say(fmt::format("deflect {:.2f} s: {}\n", seconds(), text));
  std::fflush(stderr);
}

void remark(const std::string& text) {
  if (talk != Talk::quiet) say(fmt::format("note: {}\n", text));
}

Step::Step(std::string what) : what_(std::move(what)), start_(seconds()), failing_(std::uncaught_exceptions()) {
  tell("{} …", what_);
}

Step::~Step() {
  if (verbose() && std::uncaught_exceptions() == failing_)
    tell_line(fmt::format("{}: {:.2f} s", what_, seconds() - start_));
}

}  // namespace deflect::cli
