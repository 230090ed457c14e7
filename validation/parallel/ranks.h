// The processes that mpirun started for one run, on one machine or many. Each reads the same input and takes the same
// steps; they meet where work is split (shared_cases.h) and once at the end. Nobody waits for one that has failed: its
// error comes to the next meeting in place of its work, and ends the run for all alike.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "msa/base/ending.h"

namespace deflect::parallel {

class Ranks {
 public:
  virtual ~Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }
  bool first() const { return rank_ == 0; }  ///< the one that has all results, prints and writes
  /// Processors for this rank: those it is bound to, else its share of the machine's.
  int threads() const { return threads_; }

  struct Meeting {
    std::vector<std::string> brought;  ///< at rank 0: by all, in their order; elsewhere empty
    std::string said;                  ///< by rank 0
  };
  /// All ranks come, again and again, each with bytes. Throws on all alike where one brings an error: that of the
  /// earliest case, of the lowest rank.
  Meeting meet(const std::string& mine, const std::string& said = "");

  /// The meeting of a rank that cannot go on. `at`: the case that failed, where it was one.
  static constexpr std::uint64_t no_case = UINT64_MAX;
  [[noreturn]] void meet_with(const std::exception_ptr&, std::uint64_t at = no_case);

  /// All ranks have left a meeting with an error: there will be no further one.
  bool parted() const { return parted_; }

 protected:
  Ranks(int rank, int size, int threads) : rank_(rank), size_(size), threads_(threads) {}

  /// Collective: at rank 0 the bytes of all, by rank; elsewhere nothing.
  virtual std::vector<std::string> gather(const std::string& mine) = 0;
  /// Collective: what rank 0 says.
  virtual std::string from_first(const std::string& said) = 0;

 private:
  Meeting meet(const struct Brought&, const std::string& said);

  int rank_, size_, threads_;
  bool parted_ = false;
};

/// What the launcher says in the environment; of size 0 where it does not tell how many there are. One alone where
/// DEFLECT_ALONE is set: for a program that mpirun has started and that runs deflect for itself.
struct Launched {
  int rank = 0, size = 1;
};
Launched launched();

/// Those of this run; none where this process is the only one. Throws InputError where mpirun started several and they
/// cannot find each other: no module for MPI, or one for another MPI.
std::unique_ptr<Ranks> launched_ranks();

/// A whole run: `work` on all ranks of it, nullptr where this process is the only one, and the last meeting. Returns
/// the exit code (ending.h), the same on all; what went wrong is told to `tell`, on the first rank.
int run_on_ranks(const std::function<void(Ranks*)>& work, const std::function<void(const Ending&)>& tell);

}  // namespace deflect::parallel
