// Choosing blocks of readings: one after the other, each the one that brings most for its readings; then exchanging
// each for a better one (Fedorov 1972) as long as that brings anything.
#pragma once

#include <memory>
#include <vector>

#include "validation/parallel/work.h"
#include "validation/plan/possible.h"

namespace deflect::plan {

/// What a set of blocks is good for; more is better.
class Aim {
 public:
  virtual ~Aim() = default;
  virtual double value() const = 0;
  /// The value with one more block, without taking it; from any thread.
  virtual double with(std::size_t block) const = 0;
  virtual void take(std::size_t block) = 0;
  virtual std::unique_ptr<Aim> copy() const = 0;
  /// Whether more readings are not needed.
  virtual bool reached() const { return false; }
};

struct Choice {
  std::vector<std::size_t> blocks;    ///< each the one that brings most after those before; one may stand twice
  std::vector<std::size_t> readings;  ///< number after each
  std::vector<double> values;         ///< of the aim after each
};

struct ChoiceOptions {
  std::size_t readings = 10;   ///< at most
  std::size_t most_poses = 0;  ///< 0: any number
};

/// Choices of up to 40 readings look at all blocks at every step and are exchanged; in longer ones a block is looked at
/// again when it comes near the best or another one at its pose was taken.
Choice choose(const Aim& start, const std::vector<Block>&, const ChoiceOptions&, const parallel::Work& = {});

}  // namespace deflect::plan
