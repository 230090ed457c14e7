// Messages in addition to the report: none, progress on a terminal, or every step with its time and choices.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

#include "msa/base/index.h"
#include "validation/parallel/progress.h"

namespace deflect::cli {

enum class Talk { quiet, usual, verbose };

/// For the rest of the run. Quiet discards everything on standard output.
void set_talk(Talk);
bool verbose();

/// The stream for progress of long work: watched_stream(), or none if quiet.
parallel::ProgressStream progress_stream();

/// Prints on standard error, if that can be: what becomes of the work does not depend on it.
void say(const std::string&);

/// Prints one line on standard error with the seconds since the program began: "deflect 0.12 s: …". tell() does so only
/// if verbose.
void tell_line(const std::string&);

template <class... T>
void tell(fmt::format_string<T...> format, T&&... values) {
  if (verbose()) tell_line(fmt::format(format, std::forward<T>(values)...));
}

/// Prints "note: …" on standard error, for what a user should know before the result; nothing if quiet.
void remark(const std::string&);

/// A step of the work. If verbose, prints a line when it begins and, unless it fails, one with its time when it ends.
class Step {
 public:
  explicit Step(std::string what);
  ~Step();
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;

 private:
  std::string what_;
  double start_;
  int failing_;
};

/// Runs `work` as a step and returns its result.
template <class Work>
auto timed(std::string what, const Work& work) {
  const Step step(std::move(what));
  return work();
}

/// The same for work that reports its progress; progress_stream() shows it in percent, with the time left.
template <class Work>
auto timed_with_progress(std::string what, const Work& work) {
  const Step step(std::move(what));
  parallel::Progress progress(100, "", progress_stream());
  return work([&progress](double share) { progress.update(static_cast<std::size_t>(100 * share)); });
}

}  // namespace deflect::cli
