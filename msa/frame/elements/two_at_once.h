// Two jobs side by side. What they compute must not depend on each other; then results are the same bits whether the
// second runs on a thread of its own or after the first.
#pragma once

#include <functional>
#include <memory>

namespace deflect::frame {

class TwoAtOnce {
 public:
  /// threads: 1: one after the other; else a second thread is kept until the end, for what is called many times.
  explicit TwoAtOnce(int threads);
  ~TwoAtOnce();

  /// Returns when both are done. Neither may throw.
  void operator()(const std::function<void()>& first, const std::function<void()>& second);

 private:
  struct Companion;
  std::unique_ptr<Companion> companion_;
};

/// The wanted number of threads, or as many as the machine has where it is 0.
int threads_of(int wanted);

}  // namespace deflect::frame
