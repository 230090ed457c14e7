#include "validation/plan/choice.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "msa/base/index.h"
#include "validation/parallel/cases.h"

namespace deflect::plan {
namespace {

constexpr std::size_t most_looks = 300'000;  // readings times blocks, up to which every block is looked at every time
constexpr std::size_t looked_at = 48;        // of the blocks that promise most, else
constexpr std::size_t finalists = 6;         // of those that promise most: looked at exactly
constexpr std::size_t in_order_above = 100;  // readings: the curve is in the order of the choice
constexpr int most_rounds = 3;               // of exchange one by one
constexpr int most_sweeps = 60;              // of exchange of several
constexpr int most_moves = 6;                // of a pose to another
constexpr std::size_t poses_moved = 3;       // those that are worth least are tried, where looks are dear
constexpr double worth = 1e-6;               // relative gain of an exchange

bool is_more(double value, double than) { return value > than + worth * std::abs(than); }

class Choosing {
 public:
  Choosing(const Aim& start, const std::vector<Block>& blocks, const ChoiceOptions& o, const parallel::Work& work)
      : start_(start),
        blocks_(blocks),
        o_(o),
        work_(work),
        cheap_(o.readings * blocks.size() <= most_looks),
        promise_(blocks.size(), INFINITY),
        aim_(start.copy()) {
    std::size_t poses = 0;
    for (const Block& b : blocks) poses = std::max(poses, b.pose + 1);
    at_pose_.assign(poses, 0);
  }

  Choice run() {
    for (const std::size_t b : o_.begin)
      if (blocks_[b].count <= o_.readings - used_) take(b);
    if (o_.exchange) fill();
    tell(0.5);
    for (int move = 0; move < most_moves && o_.exchange; ++move) {
      if (cheap_)
        exchange_one_by_one();
      else
        exchange_several();
      tell(0.5 + 0.5 * (move + 1) / most_moves);
      if (aim_->reached() || !move_a_pose()) break;
    }
    count();
    return std::move(out_);
  }

 private:
  void tell(double share) const {
    if (work_.progress) work_.progress(share);
  }

  void take(std::size_t block) {
    aim_->take(block);
    chosen_.push_back(block);
    used_ += blocks_[block].count;
    ++at_pose_[blocks_[block].pose];
  }

  /// Block `position` of the choice for another one, and what the aim is then.
  void exchange(std::size_t position, std::size_t block, std::unique_ptr<Aim> aim) {
    const std::size_t before = chosen_[position];
    chosen_[position] = block;
    used_ += blocks_[block].count, used_ -= blocks_[before].count;
    ++at_pose_[blocks_[block].pose], --at_pose_[blocks_[before].pose];
    aim_ = std::move(aim);
  }

  std::size_t poses_used() const {
    return as_size(std::count_if(at_pose_.begin(), at_pose_.end(), [](std::size_t n) { return n > 0; }));
  }

  /// Blocks that may be added, where one that stands at the pose `but` is taken off.
  std::vector<std::size_t> allowed(std::size_t room, std::optional<std::size_t> but = {}) const {
    const bool alone = but && at_pose_[*but] == 1;
    const bool full = o_.most_poses > 0 && poses_used() - (alone ? 1 : 0) >= o_.most_poses;
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const std::size_t pose = blocks_[i].pose;
      const bool known = at_pose_[pose] > (but == pose ? 1u : 0u);
      if (blocks_[i].count <= room && (known || !full)) out.push_back(i);
    }
    return out;
  }

  /// Whether it may stand in the place of one that was chosen.
  bool fits(std::size_t block, std::size_t position) const {
    const Block &in = blocks_[block], &out = blocks_[chosen_[position]];
    if (in.count > out.count) return false;
    return o_.most_poses == 0 || at_pose_[in.pose] > 0 ||
           poses_used() - (at_pose_[out.pose] == 1 ? 1 : 0) < o_.most_poses;
  }

  /// What each block promises for one of its readings.
  void look(const Aim& aim, const std::vector<std::size_t>& at) {
    parallel::for_each_case(at.size(), 16, work_.threads, [&](std::size_t k) {
      const double promise = aim.promise(at[k]) / static_cast<double>(blocks_[at[k]].count);
      promise_[at[k]] = std::isfinite(promise) ? promise : -INFINITY;
    });
  }

  void sort_by_promise(std::vector<std::size_t>& order) const {
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return promise_[a] > promise_[b]; });
  }

  /// The block that brings most for each of its readings.
  std::optional<std::size_t> best_of(const Aim& aim, std::vector<std::size_t> order) {
    if (order.empty()) return std::nullopt;
    if (!cheap_) {
      sort_by_promise(order);
      const auto unknown =
          std::find_if(order.begin(), order.end(), [&](std::size_t i) { return promise_[i] < INFINITY; });
      const auto fresh = std::max(as_size(unknown - order.begin()), std::min(looked_at, order.size()));
      order.resize(std::min(order.size(), fresh + looked_at));
    }
    look(aim, order);
    sort_by_promise(order);
    const double now = aim.value();
    std::size_t best = order.front();
    double most = -INFINITY;
    for (std::size_t k = 0; k < std::min(finalists, order.size()); ++k) {
      const double gain = (aim.with(order[k]) - now) / static_cast<double>(blocks_[order[k]].count);
      if (gain > most) most = gain, best = order[k];
    }
    return best;
  }

  void fill() {
    while (used_ < o_.readings && !aim_->reached()) {
      const std::optional<std::size_t> best = best_of(*aim_, allowed(o_.readings - used_));
      if (!best) return;
      take(*best);
      for (std::size_t i = 0; i < blocks_.size(); ++i)
        if (blocks_[i].pose == blocks_[*best].pose) promise_[i] = INFINITY;
      tell(0.5 * static_cast<double>(used_) / static_cast<double>(o_.readings));
    }
  }

  /// Each block in turn for the best in its place, of as many readings at most.
  void exchange_one_by_one() {
    for (int round = 0; round < most_rounds; ++round) {
      bool better = false;
      for (std::size_t i = 0; i < chosen_.size(); ++i) {
        const Block& block = blocks_[chosen_[i]];
        std::unique_ptr<Aim> rest = aim_->copy();
        rest->drop(chosen_[i]);
        const auto best = best_of(*rest, allowed(block.count, block.pose));
        if (!best || *best == chosen_[i] || !is_more(rest->with(*best), aim_->value())) continue;
        rest->take(*best);
        exchange(i, *best, std::move(rest));
        better = true;
      }
      if (!better) return;
    }
  }

  /// The positions of the choice, those that are worth least first, and what each is worth.
  std::vector<std::pair<double, std::size_t>> by_loss() const {
    std::vector<std::pair<double, std::size_t>> out(chosen_.size());
    parallel::for_each_case(out.size(), 16, work_.threads, [&](std::size_t i) {
      const double loss = aim_->loss(chosen_[i]) / static_cast<double>(blocks_[chosen_[i]].count);
      out[i] = {std::isfinite(loss) ? loss : INFINITY, i};
    });
    std::sort(out.begin(), out.end());
    return out;
  }

  /// The blocks that are worth least for those that promise most, a tenth of the choice at a time.
  void exchange_several() {
    const std::size_t at_once = std::max<std::size_t>(1, chosen_.size() / 10);
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      const double before = aim_->value();
      std::vector<std::size_t> order = allowed(o_.readings);
      look(*aim_, order);
      sort_by_promise(order);
      const auto least = by_loss();
      std::size_t failed = 0, next = 0;
      for (std::size_t k = 0; k < std::min(at_once, least.size()) && next < order.size() && failed < 8; ++k) {
        const auto& [loss, position] = least[k];
        const std::size_t block = order[next];
        if (promise_[block] <= loss) break;
        if (!fits(block, position)) {
          ++next;
          continue;
        }
        std::unique_ptr<Aim> trial = aim_->copy();
        trial->drop(chosen_[position]);
        trial->take(block);
        ++next;
        if (is_more(trial->value(), aim_->value()))
          exchange(position, block, std::move(trial));
        else
          ++failed;
      }
      if (!(aim_->value() > before + 1e-4 * std::abs(before))) return;
    }
  }

  /// An aim without the blocks at a pose, and the readings that it then lacks.
  std::pair<std::unique_ptr<Aim>, std::size_t> without_pose(std::size_t pose) const {
    std::unique_ptr<Aim> rest = aim_->copy();
    std::size_t readings = 0;
    for (const std::size_t b : chosen_)
      if (blocks_[b].pose == pose) rest->drop(b), readings += blocks_[b].count;
    return {std::move(rest), readings};
  }

  /// Blocks at one pose alone that bring most, several at a time.
  std::vector<std::size_t> best_at(std::size_t pose, Aim& aim, std::size_t readings) const {
    std::vector<std::size_t> out;
    const std::size_t at_once = std::max<std::size_t>(1, readings / 12);
    while (readings > 0) {
      std::vector<std::pair<double, std::size_t>> order;
      for (std::size_t i = 0; i < blocks_.size(); ++i)
        if (blocks_[i].pose == pose && blocks_[i].count <= readings)
          order.emplace_back(-aim.promise(i) / static_cast<double>(blocks_[i].count), i);
      if (order.empty()) return out;
      std::sort(order.begin(), order.end());
      for (std::size_t k = 0; k < std::min(at_once, order.size()); ++k) {
        const std::size_t block = order[k].second;
        if (blocks_[block].count > readings) break;
        aim.take(block);
        out.push_back(block);
        readings -= blocks_[block].count;
      }
    }
    return out;
  }

  /// Poses that are used, those without which least is lost first.
  std::vector<std::size_t> used_by_loss() const {
    std::vector<std::pair<double, std::size_t>> all;
    for (std::size_t pose = 0; pose < at_pose_.size(); ++pose)
      if (at_pose_[pose] > 0) all.emplace_back(-without_pose(pose).first->value(), pose);
    std::sort(all.begin(), all.end());
    std::vector<std::size_t> out;
    for (const auto& [value, pose] : all) out.push_back(pose);
    return out;
  }

  /// All blocks at one pose for others at a pose that is not used, where that brings anything.
  bool move_a_pose() {
    if (o_.most_poses == 0 || poses_used() < o_.most_poses) return false;
    std::vector<std::size_t> free;
    for (std::size_t pose = 0; pose < at_pose_.size(); ++pose)
      if (at_pose_[pose] == 0) free.push_back(pose);
    std::vector<std::size_t> used = used_by_loss();
    if (!cheap_) used.resize(std::min(used.size(), poses_moved));
    bool moved = false;
    for (const std::size_t from : used) {
      const auto [rest, readings] = without_pose(from);
      std::vector<std::unique_ptr<Aim>> there(free.size());
      std::vector<std::vector<std::size_t>> blocks(free.size());
      parallel::for_each_case(free.size(), 1, work_.threads, [&, &rest = rest, &readings = readings](std::size_t k) {
        there[k] = rest->copy();
        blocks[k] = best_at(free[k], *there[k], readings);
      });
      std::size_t best = free.size();
      for (std::size_t k = 0; k < free.size(); ++k)
        if (is_more(there[k]->value(), best < free.size() ? there[best]->value() : aim_->value())) best = k;
      if (best == free.size()) continue;
      move_to(from, blocks[best], std::move(there[best]));
      free[best] = from;
      moved = true;
    }
    return moved;
  }

  void move_to(std::size_t from, const std::vector<std::size_t>& blocks, std::unique_ptr<Aim> aim) {
    std::erase_if(chosen_, [&](std::size_t b) { return blocks_[b].pose == from; });
    chosen_.insert(chosen_.end(), blocks.begin(), blocks.end());
    std::fill(at_pose_.begin(), at_pose_.end(), 0);
    used_ = 0;
    for (const std::size_t b : chosen_) ++at_pose_[blocks_[b].pose], used_ += blocks_[b].count;
    aim_ = std::move(aim);
  }

  /// Those chosen again one after the other, each time the one that brings most: the curve.
  void count() {
    std::unique_ptr<Aim> aim = start_.copy();
    std::vector<std::size_t> left = std::move(chosen_);
    std::size_t used = 0;
    const bool in_order = left.size() > in_order_above;
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
  bool cheap_;
  std::vector<double> promise_;  // for each reading, when it was last looked at
  std::unique_ptr<Aim> aim_;     // of those chosen
  std::vector<std::size_t> chosen_, at_pose_;
  std::size_t used_ = 0;  // readings
  Choice out_;
};

}  // namespace

Choice choose(const Aim& start, const std::vector<Block>& blocks, const ChoiceOptions& o, const parallel::Work& work) {
  return Choosing(start, blocks, o, work).run();
}

}  // namespace deflect::plan
