// The progress of a search whose number of rounds is not known beforehand.
#pragma once

#include <functional>
#include <mutex>
#include <utility>

namespace deflect::diagnosis {

/// Rounds of candidates on a scale from 0 to 1: how many there will be is not known, each takes half of what is left.
class Rounds {
 public:
  Rounds(std::function<void(double)> tell, double from) : tell_(std::move(tell)), from_(from), to_((1 + from) / 2) {
    if (tell_) tell_(from_);
  }
  void operator()(std::size_t done, std::size_t all) {
    if (!tell_) return;
    const std::lock_guard lock(mutex_);
    tell_(from_ + (to_ - from_) * static_cast<double>(done) / static_cast<double>(all));
    if (done < all) return;
    from_ = to_;
    to_ = (1 + to_) / 2;
  }

 private:
  std::mutex mutex_;
  std::function<void(double)> tell_;
  double from_, to_;
};

}  // namespace deflect::diagnosis
