#include "validation/parallel/shared_cases.h"

#include <algorithm>
#include <mutex>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/parallel/pack.h"

namespace deflect::parallel {
namespace {

// A rank has that many cases between two meetings, at least: what becomes of one that fails is known to all by then,
// and nobody waits long for the slowest.
constexpr std::size_t rounds = 8, least = 16;

/// Of the cases from `begin` to `end` those that the rank has: every size-th, from its own number on.
struct Share {
  std::size_t first, step, count;
  std::size_t operator[](std::size_t k) const { return first + k * step; }
};

Share share_of(int rank, const Ranks& ranks, std::size_t begin, std::size_t end) {
  const auto size = as_size(ranks.size()), r = as_size(rank);
  return {begin + r, size, end - begin > r ? (end - begin - r + size - 1) / size : 0};
}

/// The work on them; where a case fails the meeting hears of it.
void work_on(const SharedCases& cases, const Share& own, Ranks& ranks, int threads,
             const std::function<void(std::size_t)>& told) {
  std::mutex mutex;
  std::size_t failed = cases.count;
  const auto one = [&](std::size_t k) {
    const std::exception_ptr thrown = thrown_by([&] { cases.work(own[k]); });
    if (!thrown) return;
    {
      const std::lock_guard lock(mutex);
      failed = std::min(failed, own[k]);
    }
    std::rethrow_exception(thrown);
  };
  if (const std::exception_ptr thrown = thrown_by([&] { for_each_case(own.count, 1, threads, one, told); }))
    ranks.meet_with(thrown, failed);
}

}  // namespace

void for_each_case(const SharedCases& cases, Ranks* ranks, int threads, const std::function<void(std::size_t)>& told) {
  if (!ranks) return for_each_case(cases.count, 1, threads, cases.work, told);
  const auto size = as_size(ranks->size());
  const std::size_t round = size * std::max(least, cases.count / (rounds * size) + 1);
  for (std::size_t begin = 0, end = 0; begin < cases.count; begin = end) {
    end = std::min(cases.count, begin + round);
    const Share own = share_of(ranks->rank(), *ranks, begin, end);
    const auto told_of_all = [&](std::size_t done) { told(std::min(end, begin + done * size)); };
    work_on(cases, own, *ranks, threads, told ? std::function<void(std::size_t)>(told_of_all) : nullptr);
    std::vector<std::string> results;
    for (std::size_t k = 0; k < own.count && !ranks->first(); ++k) results.push_back(cases.result(own[k]));
    const std::vector<std::string> brought = ranks->meet(pack(results)).brought;
    for (std::size_t r = 1; r < brought.size(); ++r) {
      const Share theirs = share_of(static_cast<int>(r), *ranks, begin, end);
      results = unpack<std::vector<std::string>>(brought[r]);
      for (std::size_t k = 0; k < theirs.count; ++k) cases.take(theirs[k], results.at(k));
    }
  }
}

}  // namespace deflect::parallel
