#include "validation/plan/choice.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "msa/base/index.h"
#include "validation/parallel/cases.h"

namespace deflect::plan {
namespace {

constexpr std::size_t short_plan = 40;  // readings
constexpr std::size_t looked_at = 48;   // of the blocks that promise most, in a long one
constexpr int most_rounds = 3;          // of exchange
constexpr double worth = 1e-6;          // relative gain of an exchange

class Choosing {
 public:
  Choosing(const Aim& start, const std::vector<Block>& blocks, const ChoiceOptions& o, const parallel::Work& work)
      : start_(start), blocks_(blocks), o_(o), work_(work), promise_(blocks.size(), INFINITY) {}

  Choice run() {
    std::unique_ptr<Aim> aim = start_.copy();
    std::size_t used = 0;
    while (used < o_.readings) {
      const std::optional<std::size_t> best = best_of(*aim, o_.readings - used, out_.blocks);
      if (!best) break;
      aim->take(*best);
      out_.blocks.push_back(*best);
      used += blocks_[*best].count;
      for (std::size_t i = 0; i < blocks_.size(); ++i)
        if (blocks_[i].pose == blocks_[*best].pose) promise_[i] = INFINITY;
      if (work_.progress) work_.progress(0.9 * static_cast<double>(used) / static_cast<double>(o_.readings));
      if (aim->reached()) break;
    }
    if (used <= short_plan) exchange();
    count();
    return std::move(out_);
  }

 private:
  bool allowed(std::size_t block, std::size_t room, const std::vector<std::size_t>& chosen) const {
    if (blocks_[block].count > room) return false;
    if (o_.most_poses == 0) return true;
    std::set<std::size_t> poses = {blocks_[block].pose};
    for (const std::size_t b : chosen) poses.insert(blocks_[b].pose);
    return poses.size() <= o_.most_poses;
  }

  /// The block that brings most for each of its readings.
  std::optional<std::size_t> best_of(const Aim& aim, std::size_t room, const std::vector<std::size_t>& chosen) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < blocks_.size(); ++i)
      if (allowed(i, room, chosen)) order.push_back(i);
    if (order.empty()) return std::nullopt;
    const double now = aim.value();
    const auto look = [&](const std::vector<std::size_t>& at) {
      parallel::for_each_case(at.size(), 16, work_.threads, [&](std::size_t k) {
        promise_[at[k]] = (aim.with(at[k]) - now) / static_cast<double>(blocks_[at[k]].count);
      });
    };
    const auto more = [&](std::size_t a, std::size_t b) { return promise_[a] > promise_[b]; };
    if (o_.readings <= short_plan) {
      look(order);
    } else {
      std::stable_sort(order.begin(), order.end(), more);
      const auto unknown =
          std::find_if(order.begin(), order.end(), [&](std::size_t i) { return promise_[i] < INFINITY; });
      const auto fresh = std::max(as_size(unknown - order.begin()), std::min(looked_at, order.size()));
      order.resize(std::min(order.size(), fresh + looked_at));
      look(order);
    }
    return *std::min_element(order.begin(), order.end(), more);
  }

  /// Each block in turn for the best in its place, of as many readings at most.
  void exchange() {
    for (int round = 0; round < most_rounds; ++round) {
      bool better = false;
      for (std::size_t i = 0; i < out_.blocks.size(); ++i) {
        std::vector<std::size_t> others = out_.blocks;
        others.erase(others.begin() + as_index(i));
        std::unique_ptr<Aim> rest = start_.copy();
        for (const std::size_t b : others) rest->take(b);
        const double kept = rest->with(out_.blocks[i]);
        std::fill(promise_.begin(), promise_.end(), INFINITY);
        const auto best = best_of(*rest, blocks_[out_.blocks[i]].count, others);
        if (!best || *best == out_.blocks[i]) continue;
        if (!(rest->with(*best) > kept + worth * std::abs(kept))) continue;
        out_.blocks[i] = *best;
        better = true;
      }
      if (!better) return;
    }
  }

  /// The exchanged ones again one after the other, each time the one that brings most: the curve.
  void count() {
    std::unique_ptr<Aim> aim = start_.copy();
    std::vector<std::size_t> left = std::move(out_.blocks);
    out_ = {};
    std::size_t used = 0;
    const bool in_order = left.size() > short_plan;
    while (!left.empty()) {
      std::size_t next = 0;
      double most = -INFINITY;
      for (std::size_t i = 0; i < left.size() && !in_order; ++i)
        if (const double value = aim->with(left[i]); value > most) most = value, next = i;
      aim->take(left[next]);
      used += blocks_[left[next]].count;
      out_.blocks.push_back(left[next]);
      out_.readings.push_back(used);
      out_.values.push_back(aim->value());
      left.erase(left.begin() + as_index(next));
      if (aim->reached()) break;
    }
  }

  const Aim& start_;
  const std::vector<Block>& blocks_;
  const ChoiceOptions& o_;
  const parallel::Work& work_;
  std::vector<double> promise_;  // gain for each reading, when it was last looked at
  Choice out_;
};

}  // namespace

Choice choose(const Aim& start, const std::vector<Block>& blocks, const ChoiceOptions& o, const parallel::Work& work) {
  return Choosing(start, blocks, o, work).run();
}

}  // namespace deflect::plan
