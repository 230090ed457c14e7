// The loop from a tie to its end: two effects that the paper's plan cannot tell apart, readings that are planned, the
// same machine read there, both fitted to everything.
//
// A truth is one of the pair, by turns, in a machine drawn within all tolerances and read by the MSA in the deformed
// shape. Its parameters are drawn as a plan takes them to be before any reading, even over their coordinates, until the
// readings of the paper's plan show λ, within a quarter: what is chosen by the readings alone is distributed as a plan
// takes it to be after them. Beside the plan stand the readings of the campaign
// "random", in its order, that promise the same probability of the true effect. Truths that the paper's plan has
// decided already, by a probability of 0.95 for either, are counted apart: they are no ties.
#pragma once

#include <string>
#include <vector>

#include "validation/effects/effect.h"

namespace deflect::benchmark {

struct Tied {
  std::string subject, first, second;  ///< built-in device or frame; effects
  double lambda = 8;                   ///< that the paper's plan shows, within a quarter
  double moment = 0;                   ///< Nm: largest of the rig; 0: 1 Nm, the force on a lever of 20 mm
  bool nodes = false;                  ///< of a frame: forces at all nodes can be planned too
};

struct LoopResult {
  std::string truth, skipped;
  bool tied = true;                ///< by the paper's plan
  double before = 0;               ///< χ² of the wrong one − χ² of the true one on the paper's plan
  std::size_t planned = 0;         ///< readings
  std::size_t at_random = 0;       ///< of the campaign "random" for the same expected probability
  bool at_random_is_more = false;  ///< than that
  std::size_t by_lot = 0;  ///< of the readings that could be planned, drawn by lot, for the same; 0: not reached
  double predicted = 0;    ///< λ² that the planned readings add, mean over what the paper's plan leaves open
  double found = 0;        ///< χ² of the wrong one − χ² of the true one, by how much it has grown
  bool right = false;      ///< the true one fits better in the end
  double seconds = 0;      ///< of planning
};

std::vector<LoopResult> run_loops(const Tied&, std::size_t truths, std::uint64_t seed, int threads);

/// One row for each pair: medians, right ones, slope of found over predicted through the origin.
std::string loop_table(const std::vector<std::pair<Tied, std::vector<LoopResult>>>&);

}  // namespace deflect::benchmark
