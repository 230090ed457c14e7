// What the program tells beside its report: nothing, progress on a terminal, or every step with its time and choices.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

#include "validation/parallel/progress.h"

namespace deflect::cli {

enum class Talk { quiet, usual, verbose };

/// For the rest of the run. Quiet: reports, and whatever else goes to standard output, are thrown away.
void set_talk(Talk);
bool verbose();

/// Where progress of long work is shown: watched_stream(), nowhere when quiet.
ProgressStream progress_stream();

/// One line on standard error where verbose, with the seconds since the program began: "deflect 0.12 s: …".
void tell_line(const std::string&);

template <class... T>
void tell(fmt::format_string<T...> format, T&&... values) {
  if (verbose()) tell_line(fmt::format(format, std::forward<T>(values)...));
}

/// One line on standard error, "note: …", of what a user should know before the result; nothing when quiet.
void remark(const std::string&);

/// A step of the work, told when it begins and, unless it fails, when it is done, with its time.
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

/// What `work` returns, as a step.
template <class Work>
auto timed(std::string what, const Work& work) {
  const Step step(std::move(what));
  return work();
}

/// The same for work that tells how far it has come: shown on progress_stream() in percent, with the time left.
template <class Work>
auto timed_with_progress(std::string what, const Work& work) {
  const Step step(std::move(what));
  Progress progress(100, "", progress_stream());
  return work([&progress](double share) { progress.update(static_cast<std::size_t>(100 * share)); });
}

}  // namespace deflect::cli
