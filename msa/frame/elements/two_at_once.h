// Runs two jobs in parallel. They must not depend on each other; then results are bit-identical whether the second runs
// on its own thread or after the first.
#pragma once

#include <functional>
#include <memory>

namespace deflect::frame {

class TwoAtOnce {
 public:
  /// `threads`: 1: one after the other; else a second thread is kept until destruction, for many calls.
  explicit TwoAtOnce(int threads);
  ~TwoAtOnce();

  /// Returns when both are done. Neither may throw.
  void operator()(const std::function<void()>& first, const std::function<void()>& second);

 private:
  struct Companion;
  std::unique_ptr<Companion> companion_;
};

/// `wanted`, or the machine's number of threads where it is 0.
int threads_of(int wanted);

}  // namespace deflect::frame
