// A progress line on a terminal: how much of a long piece of work is done and how long the rest will take.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <ostream>
#include <string>

namespace deflect::parallel {

/// Where progress is shown, if anywhere: on one line that is redrawn, or line after line.
struct ProgressStream {
  ProgressStream(std::ostream* to, bool line_after_line = false) : out(to), lines(line_after_line) {}
  std::ostream* out;
  bool lines;
};

/// Standard error. One redrawn line if it is a terminal, separate lines under mpirun, otherwise nothing.
ProgressStream watched_stream();

/// One redrawn line: it appears after one second, changes at most ten times a second, and the destructor wipes it. Or
/// separate lines, one in ten seconds. Silent without a stream. The time left assumes a constant speed.
class Progress {
 public:
  using Clock = std::function<double()>;  ///< seconds from any beginning

  /// `what` names the pieces, such as "poses"; if it is empty, no count is shown. The stream must outlive the object.
  Progress(std::size_t total, std::string what, ProgressStream, Clock clock = steady_seconds);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// From any thread. A number below an earlier one has no effect.
  void update(std::size_t done);

  static double steady_seconds();

 private:
  std::mutex mutex_;
  std::size_t total_, done_ = 0;
  std::string what_;
  ProgressStream stream_;
  Clock clock_;
  double start_, drawn_;
  bool visible_ = false;
};

/// "5 s", "3 min 20 s", "2 h 5 min"; rounded up, so that it does not say 0 before the end.
std::string duration_text(double seconds);

}  // namespace deflect::parallel
