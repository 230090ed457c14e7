// Cases that the ranks of a run share, and threads within each.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "validation/parallel/cases.h"
#include "validation/parallel/ranks.h"

namespace deflect::parallel {

struct SharedCases {
  std::size_t count = 0;
  std::function<void(std::size_t)> work;
  /// What work(i) has left, on the rank that did it, as bytes (pack.h), and from them on rank 0.
  std::function<std::string(std::size_t)> result;
  std::function<void(std::size_t, const std::string&)> take;
};

/// Works through all cases, rank 0 having all results in the end and every other its own; without ranks this process
/// alone. Results and errors are the same for any number of ranks and threads: where cases fail the first one's error
/// is thrown on, on all ranks. `told` as by for_each_case(), as if the other ranks were as far as this one.
void for_each_case(const SharedCases&, Ranks*, int threads, const std::function<void(std::size_t done)>& told = {});

}  // namespace deflect::parallel
