// Ranks that are threads of this process: the meetings of a run under mpirun, without MPI.
#pragma once

#include <barrier>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "validation/parallel/ranks.h"

namespace deflect::test {

class ThreadRanks {
 public:
  explicit ThreadRanks(int size) : brought_(static_cast<std::size_t>(size)), barrier_(size) {}

  /// Runs `work` on all ranks; how each of them ended, `work` and the last meeting.
  std::vector<Ending> run(const std::function<void(parallel::Ranks&)>& work) {
    std::vector<Ending> ends(brought_.size());
    {
      std::vector<std::jthread> threads;
      for (std::size_t r = 0; r < ends.size(); ++r)
        threads.emplace_back([this, &work, &ends, r] {
          Rank rank(*this, static_cast<int>(r));
          try {
            try {
              work(rank);
              rank.meet("");
            } catch (...) {
              if (rank.parted()) throw;
              rank.meet_with(std::current_exception());
            }
          } catch (...) {
            ends[r] = ending_of(std::current_exception());
          }
        });
    }
    return ends;
  }

 private:
  struct Rank : parallel::Ranks {
    Rank(ThreadRanks& together, int rank)
        : parallel::Ranks(rank, static_cast<int>(together.brought_.size()), 1), together_(together) {}

    std::vector<std::string> gather(const std::string& mine) override {
      together_.brought_[static_cast<std::size_t>(rank())] = mine;
      together_.barrier_.arrive_and_wait();
      std::vector<std::string> out = first() ? together_.brought_ : std::vector<std::string>();
      together_.barrier_.arrive_and_wait();
      return out;
    }
    std::string from_first(const std::string& said) override {
      if (first()) together_.said_ = said;
      together_.barrier_.arrive_and_wait();
      std::string out = together_.said_;
      together_.barrier_.arrive_and_wait();
      return out;
    }

    ThreadRanks& together_;
  };

  std::vector<std::string> brought_;
  std::string said_;
  std::barrier<> barrier_;
};

}  // namespace deflect::test
