// A line on a terminal that says how far a long piece of work has come and how long it will still take.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <ostream>
#include <string>

namespace deflect {

/// Where progress is shown, if anywhere: on one line that is drawn over, or line after line.
struct ProgressStream {
  ProgressStream(std::ostream* to, bool line_after_line = false) : out(to), lines(line_after_line) {}
  std::ostream* out;
  bool lines;
};

/// Standard error: drawn over where it is a terminal; lines where mpirun stands before the terminal; else nothing.
ProgressStream watched_stream();

/// Silent for the first second, and without a stream altogether; then a line that is drawn over at most ten times a
/// second and wiped away by the destructor; or lines that stay, one in ten seconds. The time left supposes that the
/// rest goes as fast as what is done.
class Progress {
 public:
  using Clock = std::function<double()>;  ///< seconds from any beginning

  /// `what` names the pieces: "poses"; empty: they are not counted out. The stream must outlive the object.
  Progress(std::size_t total, std::string what, ProgressStream, Clock clock = steady_seconds);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// From any thread; a smaller number than one already told changes nothing.
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

}  // namespace deflect
