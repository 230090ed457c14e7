// Choosing blocks of readings: one after the other, each the one that brings most for its readings; then exchanging
// each for a better one (Fedorov 1972), and all of a pose for others at another pose, as long as that brings anything.
#pragma once

#include <memory>
#include <vector>

#include "validation/parallel/work.h"
#include "validation/plan/possible.h"

namespace deflect::plan {

/// What a set of blocks is good for; more is better. The const functions can be called from any thread.
class Aim {
 public:
  virtual ~Aim() = default;
  virtual double value() const = 0;
  /// The value with one more block, without taking it.
  virtual double with(std::size_t block) const = 0;
  virtual void take(std::size_t block) = 0;
  /// A block that was taken is taken off again.
  virtual void drop(std::size_t block) = 0;
  virtual std::unique_ptr<Aim> copy() const = 0;
  /// By how much a block would raise the value, and by how much the value falls without one that was taken; an aim may
  /// estimate them.
  virtual double promise(std::size_t block) const { return with(block) - value(); }
  virtual double loss(std::size_t block) const {
    const std::unique_ptr<Aim> rest = copy();
    rest->drop(block);
    return value() - rest->value();
  }
  /// Whether more readings are not needed.
  virtual bool reached() const { return false; }
};

struct Choice {
  std::vector<std::size_t> blocks;    ///< each the one that brings most after those before; one may stand twice
  std::vector<std::size_t> readings;  ///< number after each
  std::vector<double> values;         ///< of the aim after each
};

struct ChoiceOptions {
  std::size_t readings = 10;            ///< at most
  std::size_t most_poses = 0;           ///< 0: any number
  bool exchange = true;                 ///< else `begin` alone, neither filled up nor exchanged
  std::vector<std::size_t> begin = {};  ///< blocks to begin with, which are filled up and exchanged
};

/// Where readings times blocks are few, all blocks are looked at at every step, and for each that was chosen. Else a
/// block is looked at again when it comes near the best or another one at its pose was taken, and those that are worth
/// least are exchanged for those that promise most, several at a time.
Choice choose(const Aim& start, const std::vector<Block>&, const ChoiceOptions&, const parallel::Work& = {});

}  // namespace deflect::plan
