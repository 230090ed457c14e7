#include "validation/parallel/cases.h"
#include "msa/base/outcome.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace deflect::parallel {

void for_each_case(std::size_t n, std::size_t chunk, int threads, const std::function<void(std::size_t)>& work,
                   const std::function<void(std::size_t)>& told) {
  const std::size_t chunks = (n + chunk - 1) / chunk;
  // Chunks are taken in order, so that everything before a failed one has been or is being looked at: the error that
  // is reported does not depend on the threads.
  std::atomic<std::size_t> next = 0, done = 0, failed = chunks;
  std::mutex mutex;
  std::exception_ptr error;
  const auto run = [&] {
    for (std::size_t c = next++; c < failed; c = next++) {
      const std::exception_ptr thrown = thrown_by([&] {
        const std::size_t end = std::min((c + 1) * chunk, n);
        for (std::size_t i = c * chunk; i < end; ++i) work(i);
        const std::size_t now = done += end - c * chunk;
        if (told) told(now);
      });
      if (!thrown) continue;
      const std::lock_guard lock(mutex);
      if (c < failed) {
        failed = c;
        error = thrown;
      }
    }
  };
  const unsigned wanted = threads > 0 ? static_cast<unsigned>(threads) : std::thread::hardware_concurrency();
  {
    std::vector<std::jthread> others;
    for (unsigned t = 1; t < std::min<std::size_t>(std::max(wanted, 1u), chunks); ++t) others.emplace_back(run);
    run();
  }
  if (error) std::rethrow_exception(error);
}

Told part_of(const Told& whole, double from, double to) {
  if (!whole) return {};
  return [whole, from, to](double share) { whole(from + (to - from) * share); };
}

}  // namespace deflect::parallel
