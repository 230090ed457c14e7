// How work is done, beside what it is: no result depends on it.
#pragma once

#include "validation/parallel/cases.h"

namespace deflect::parallel {

class Journal;
class Ranks;

struct Work {
  int threads = 0;         ///< 0: as many as the machine has
  Ranks* ranks = nullptr;  ///< processes that share it; none: this one alone
  Told progress = {};
  Journal* journal = nullptr;  ///< keeps finished cases of one loop for the next run; none: nothing is kept

  /// The same for a part of it, from … to of the whole.
  Work part(double from, double to) const { return {threads, ranks, part_of(progress, from, to), journal}; }
  /// The same without a word.
  Work quiet() const { return {threads, ranks, {}, journal}; }
};

/// In this thread alone, without a word: of work that is done beside other work.
inline const Work alone = {1};

}  // namespace deflect::parallel
