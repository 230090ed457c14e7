#include "msa/frame/elements/two_at_once.h"

#include <algorithm>
#include <atomic>
#include <thread>

namespace deflect::frame {

struct TwoAtOnce::Companion {
  const std::function<void()>* job = nullptr;
  std::atomic<int> asked{0}, done{0};  // numbers of jobs; asked < 0: no more
  std::thread thread{[this] {
    for (int n = 0;; ++n) {
      asked.wait(n);
      if (asked.load() < 0) return;
      (*job)();
      done.store(n + 1);
      done.notify_one();
    }
  }};
};

TwoAtOnce::TwoAtOnce(int threads) {
  if (threads_of(threads) > 1) companion_ = std::make_unique<Companion>();
}

TwoAtOnce::~TwoAtOnce() {
  if (!companion_) return;
  companion_->asked.store(-1);
  companion_->asked.notify_one();
  companion_->thread.join();
}

void TwoAtOnce::operator()(const std::function<void()>& first, const std::function<void()>& second) {
  if (!companion_) {
    first();
    second();
    return;
  }
  Companion& c = *companion_;
  const int n = c.done.load();
  c.job = &second;
  c.asked.store(n + 1);
  c.asked.notify_one();
  first();
  c.done.wait(n);
}

int threads_of(int wanted) {
  return wanted > 0 ? wanted : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace deflect::frame
